"""What a killed process leaves is removed by the next; what a living one uses is not."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from palpate.core.bake.lease import lease, sweep_leases
from palpate.core.files.atomic_file import atomic_file
from palpate.core.files.scratch_folder import LOCK_FILE, ScratchFolder, sweep

pytestmark = pytest.mark.skipif(os.name != "posix", reason="kills processes")

HOLDER = """
import os, sys, tempfile, time
from pathlib import Path
from palpate.core.files.atomic_file import atomic_file
from palpate.core.files.scratch_folder import ScratchFolder
tempfile.tempdir = sys.argv[1]
scratch = ScratchFolder("bake")
(scratch.path / "large").write_bytes(bytes(1000))
with atomic_file(Path(sys.argv[1]) / "body.npz") as file:
    file.write(b"half")
    print(scratch.path, flush=True)
    time.sleep(600)
"""


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    return tmp_path


@pytest.fixture
def holder(place):
    """Start a process that holds a folder and an unfinished file; all are killed at the end."""
    begun = []

    def start():
        process = subprocess.Popen(
            [sys.executable, "-c", HOLDER, str(place)], stdout=subprocess.PIPE, text=True
        )
        begun.append(process)
        assert process.stdout.readline().strip()
        return process

    yield start
    for process in begun:
        process.kill()
        process.wait()
        process.stdout.close()


def killed(process):
    process.send_signal(signal.SIGKILL)
    process.wait()


def test_only_what_no_living_process_holds_is_swept(place, holder):
    dead, living = holder(), holder()
    assert len(list(place.glob("palpate-bake-*"))) == 2
    assert sweep(("bake",)) == []
    killed(dead)
    assert len(sweep(("bake",))) == 1
    assert len(list(place.glob("palpate-bake-*"))) == 1
    with atomic_file(place / "body.npz") as file:
        file.write(b"whole")
    assert len(list(place.glob(".body.npz.*.tmp"))) == 1
    killed(living)
    with atomic_file(place / "body.npz") as file:
        file.write(b"whole")
    assert sweep(("bake",)) != []
    assert sorted(path.name for path in place.iterdir()) == ["body.npz"]


def test_a_child_that_outlives_its_parent_keeps_the_folder(place):
    scratch = ScratchFolder("bake")
    code = (
        "import sys; from pathlib import Path; from palpate.core.files.scratch_folder import held"
    )
    code += "; held(Path(sys.argv[1])); print('held', flush=True); sys.stdin.read()"
    with subprocess.Popen(
        [sys.executable, "-c", code, str(scratch.path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as child:
        child.stdout.readline()
        os.close(scratch._lock)
        assert sweep(("bake",)) == []
        child.stdin.close()
        child.wait()
    assert sweep(("bake",)) == [scratch.path]


def test_folders_without_a_lock_are_left_for_a_day(place):
    old, new = place / "palpate-bake-old", place / "palpate-bake-new"
    for folder in (old, new):
        folder.mkdir()
    os.utime(old, (0, time.time() - 2 * 24 * 3600))
    assert sweep(("bake",)) == [old]
    assert new.is_dir()


def test_neither_links_nor_others_names_are_swept(place):
    kept = place / "kept"
    kept.mkdir()
    (kept / LOCK_FILE).touch()
    (place / "palpate-bake-link").symlink_to(kept)
    (place / "palpate-other-x").mkdir()
    (place / "palpate-other-x" / LOCK_FILE).touch()
    (place / ".body.npz.notours.tmp").touch()
    assert sweep(("bake",)) == []
    with atomic_file(place / "body.npz"):
        pass
    assert (kept / LOCK_FILE).exists()
    assert (place / ".body.npz.notours.tmp").exists()


def test_a_scratch_folder_is_removed_with_its_lock(place):
    with ScratchFolder("bake") as scratch:
        assert (scratch.path / LOCK_FILE).exists()
        assert sweep(("bake",)) == []
    scratch.remove()
    assert list(place.iterdir()) == []


LESSEE = """
import sys, time
from pathlib import Path
from palpate.core.bake.lease import lease
with lease(Path(sys.argv[1])) as sign:
    print(sign.path, flush=True)
    time.sleep(600)
"""


def test_leases_of_killed_processes_are_swept_and_others_kept(tmp_path):
    def lessee():
        process = subprocess.Popen(
            [sys.executable, "-c", LESSEE, str(tmp_path)], stdout=subprocess.PIPE, text=True
        )
        return process, Path(process.stdout.readline().strip())

    (dead, left), (living, kept) = lessee(), lessee()
    try:
        elsewhere = tmp_path / f"{left.name[:-8]}00000000"
        elsewhere.write_text("another computer's")
        killed(dead)
        with lease(tmp_path) as own:
            assert own.is_seen()
            assert {path.name for path in tmp_path.iterdir()} == {
                own.path.name,
                kept.name,
                elsewhere.name,
            }
        killed(living)
        sweep_leases(tmp_path)
        assert [path.name for path in tmp_path.iterdir()] == [elsewhere.name]
    finally:
        for process in (dead, living):
            process.kill()
            process.wait()
            process.stdout.close()


def test_a_sweep_that_is_killed_leaves_what_the_next_one_sweeps(place, holder, monkeypatch):
    dead = holder()
    killed(dead)
    (folder,) = place.glob("palpate-bake-*")
    monkeypatch.setattr("shutil.rmtree", lambda *_, **__: None)
    sweep(("bake",))
    assert [path.name for path in folder.iterdir()] == [LOCK_FILE]
    monkeypatch.undo()
    monkeypatch.setattr("tempfile.tempdir", str(place))
    assert sweep(("bake",)) == [folder]
    assert not folder.exists()
