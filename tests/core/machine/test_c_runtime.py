"""Children in Python find Microsoft's C runtime where this process has it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from palpate.core.machine import c_runtime

ON_WINDOWS = pytest.mark.skipif(sys.platform != "win32", reason="Windows: elsewhere there is none")
RUNTIME = Path("programs") / "blender.crt"
LOADS = "import ctypes; ctypes.WinDLL('palpate_probe.dll')"
TAKES = "from palpate.core.machine.c_runtime import take; take(); "


def test_the_runtime_comes_last_and_hides_nothing():
    given = {"PATH": "first", "HOME": "there"}
    variables = c_runtime.environment(given, RUNTIME)
    assert variables["PATH"] == f"first{os.pathsep}{RUNTIME}"
    assert variables[c_runtime.VARIABLE] == str(RUNTIME)
    assert variables["HOME"] == "there"
    assert given == {"PATH": "first", "HOME": "there"}


def test_without_a_path_it_is_the_only_folder():
    assert c_runtime.environment({}, RUNTIME)["PATH"] == str(RUNTIME)


def test_where_there_is_no_runtime_nothing_changes():
    assert c_runtime.environment({"PATH": "first"}, None) == {"PATH": "first"}


@pytest.mark.skipif(sys.platform == "win32", reason="there is one on Windows")
def test_other_systems_have_none_and_children_their_parents_variables():
    assert c_runtime.folder() is None
    assert c_runtime.for_a_child() == dict(os.environ)


@ON_WINDOWS
def test_the_folder_holds_the_runtime():
    assert (c_runtime.folder() / c_runtime.LIBRARY).is_file()


@ON_WINDOWS
@pytest.mark.parametrize(("program", "is_loaded"), [(LOADS, False), (TAKES + LOADS, True)])
def test_a_child_that_takes_it_finds_libraries_there(tmp_path, program, is_loaded):
    folder = tmp_path / "blender.crt of Jörg"
    folder.mkdir()
    shutil.copy(c_runtime.folder() / c_runtime.LIBRARY, folder / "palpate_probe.dll")
    done = subprocess.run(
        [sys.executable, "-c", program],
        check=False,
        env=c_runtime.environment(os.environ, folder),
        capture_output=True,
    )
    assert (done.returncode == 0) is is_loaded, done.stderr.decode(errors="replace")
