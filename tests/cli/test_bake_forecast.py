"""What a bake will take is said before it, and what it does meanwhile."""

from __future__ import annotations

import json
import subprocess
import sys
import time

import pytest
import trimesh

from palpate.cli.bake import forecast, status_line


@pytest.fixture
def cube(tmp_path):
    """A unit cube of twelve triangles: as fine as one likes."""
    path = tmp_path / "cube.obj"
    trimesh.creation.box((1, 1, 1)).export(path)
    return path


def test_a_bake_that_no_memory_holds_is_refused_at_once(cube, refusal, monkeypatch):
    monkeypatch.setattr(forecast, "available_memory", lambda: 2 * 10**9)
    said = refusal("bake", cube, "-o", cube.with_name("out.npz"), "--edge-length", 0.004)
    assert str(cube) in said
    assert "use --edge-length 0.0" in said
    assert not cube.with_name("out.npz").exists()


def test_the_edge_length_that_is_offered_fits(cube, refusal, monkeypatch, palpate):
    monkeypatch.setattr(forecast, "available_memory", lambda: 2 * 10**9)
    words = ["bake", cube, "-o", cube.with_name("out.npz"), "--edge-length"]
    offered = refusal(*words, 0.004).rpartition("--edge-length ")[2].split()[0]
    status, printed, _ = palpate("bake", cube, "--predict", "--edge-length", offered, "--json")
    assert status == 0
    assert json.loads(printed)["predictions"][0]["peak_bytes"] <= 2 * 10**9


@pytest.mark.skipif(sys.platform == "win32", reason="who is ended there has no last word")
def test_a_long_bake_is_announced_and_can_be_stopped(cube):
    words = ["bake", cube, "-o", cube.with_name("out.npz"), "--edge-length", "0.0125"]
    with subprocess.Popen(
        [sys.executable, "-m", "palpate.cli.main", *map(str, words)],
        stderr=subprocess.PIPE,
        text=True,
    ) as program:
        first = program.stderr.readline()
        program.terminate()
        last = program.stderr.read().splitlines()[-1]
    assert "118,057 nodes" in first
    assert " min" in first
    assert "with --edge-length 0.025 about" in first
    assert last == "palpate: stopped"
    assert not cube.with_name("out.npz").exists()


def test_a_short_bake_says_nothing(cube, palpate):
    words = ["-o", cube.with_name("out.npz"), "--edge-length", 0.2, "--json"]
    status, _, said = palpate("bake", cube, *words)
    assert (status, said) == (0, "")


def test_without_a_terminal_there_is_a_line_now_and_then(monkeypatch, capsys):
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    with status_line.status_line() as line:
        for second in range(61):
            now[0] = 100.0 + second
            line.show(f"after {second} s")
    said = capsys.readouterr().err.splitlines()
    assert said == [f"palpate: after {second} s" for second in (20, 40, 60)]
