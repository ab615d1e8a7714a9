"""The check of a release tells of every step, also after one that fails."""

import subprocess

import pytest
import release_check
from release_check import main, steps


@pytest.fixture
def ran(monkeypatch, tmp_path):
    """Commands that were run, of which lint fails; one part of the tests keeps a report."""
    commands = []
    monkeypatch.setattr(release_check, "REPORTS", tmp_path)
    (tmp_path / "lint.txt").write_text("of a run before\n")

    def run(command, **_):
        commands.append(command)
        if command[-1] == "test-core":
            (tmp_path / "test-core.txt").write_text("...\n3000 passed in 100 s\n\n")
        return subprocess.CompletedProcess(command, int(command[-1] == "lint"))

    return commands, run


def test_one_that_fails_is_told_and_the_others_still_run(ran, capsys):
    commands, run = ran
    assert main(["make lint", "make test-core"], run) == 1
    assert commands == [("make", "lint"), ("make", "test-core")]
    heading, lint, core = capsys.readouterr().out.splitlines()[-3:]
    assert heading.split() == ["what", "outcome", "minutes", "closing", "line"]
    assert lint.split() == ["make", "lint", "failed", "0.0"]
    assert core.split()[:4] == ["make", "test-core", "passed", "0.0"]
    assert core.endswith("3000 passed in 100 s")


def test_what_cannot_be_run_is_no_failure_and_is_not_run(ran, capsys, monkeypatch):
    commands, run = ran
    monkeypatch.setattr(release_check.os, "geteuid", lambda: 1000, raising=False)
    assert main(["make test-windows-native"], run) == 0
    assert commands == []
    assert "cannot be run here" in capsys.readouterr().out


def test_every_step_is_a_target_that_there_is():
    makefile = (release_check.REPOSITORY / "Makefile").read_text(encoding="utf-8")
    for step in steps():
        if step.command[0] == "make" and not step.name.startswith("make test-addon-"):
            assert f"\n{step.command[-1]}:" in makefile, step.name
