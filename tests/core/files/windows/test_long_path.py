"""Paths beyond 260 characters, by Microsoft's rules for the form that has no limit."""

from pathlib import Path, PureWindowsPath

import pytest

from palpate.core.files.atomic_file import atomic_file
from palpate.core.files.npz_archive import opened, read_arrays, write_arrays
from palpate.core.files.own_file import is_free, is_ordinary, is_own
from palpate.core.files.windows.long_path import LONGEST_PLAIN, extended, reaching
from palpate.core.files.windows.set_aside import discard

LONG = "a" * LONGEST_PLAIN
OTHERS = ("folder", "b" * 120, "c" * 120)


@pytest.mark.parametrize(
    ("path", "form"),
    [
        (rf"C:\{LONG}\cube.npz", rf"\\?\C:\{LONG}\cube.npz"),
        (rf"\\server\share\{LONG}\cube.npz", rf"\\?\UNC\server\share\{LONG}\cube.npz"),
        (rf"\\?\C:\{LONG}\cube.npz", rf"\\?\C:\{LONG}\cube.npz"),
        (rf"\\.\pipe\{LONG}", rf"\\.\pipe\{LONG}"),
        (r"C:\scene\palpate\cube.npz", r"C:\scene\palpate\cube.npz"),
    ],
)
def test_long_paths_take_the_form_without_a_limit(path, form):
    assert extended(path) == form
    assert PureWindowsPath(form).name == PureWindowsPath(path).name


def test_there_is_room_for_the_names_of_unfinished_files():
    folder = "C:\\" + "a" * (LONGEST_PLAIN - 3)
    name = PureWindowsPath(folder).name
    beside = PureWindowsPath(folder).with_name(f".{name}.01234567.palpate-replaced")
    assert len(str(beside)) < 248


def test_a_file_is_written_read_and_removed_in_a_deep_folder(tmp_path):
    target = tmp_path.joinpath(*OTHERS, "d" * 100 + ".npz")
    for times in range(2):
        with atomic_file(target, make_folders=True) as file:
            write_arrays(file, {"format": "deep", "times": times})
        assert read_arrays(target)["times"] == times
    with opened(target) as archive:
        assert archive.names == ["format", "times"]
    assert is_ordinary(target)
    assert is_own(target, "deep")
    discard(target)
    assert is_free(target, "deep")
    assert list(reaching(target.parent).iterdir()) == []


def test_elsewhere_a_path_stays_as_it_is(monkeypatch):
    monkeypatch.setattr("os.name", "posix")
    assert reaching(Path("cube.npz")) == Path("cube.npz")
