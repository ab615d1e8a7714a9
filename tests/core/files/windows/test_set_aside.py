"""Files that are mapped are replaced and removed, on Windows and on a pretence of it.

The pretence refuses what Windows refuses of a mapped file: to replace it and to delete it, not to
give it another name.
"""

from pathlib import Path

import pytest

from palpate.core.files.atomic_file import UnwritableError, atomic_file
from palpate.core.files.windows import patience
from palpate.core.files.windows.patience import PAUSES
from palpate.core.files.windows.set_aside import REMOVED, REPLACED, discard, sweep_aside, take_place

plain_replace, plain_rename, plain_unlink = Path.replace, Path.rename, Path.unlink


class Windows:
    """Files by their numbers that are `mapped`, and that a scanner holds, so many times."""

    def __init__(self):
        self.mapped, self.held = set(), {}

    def number(self, path):
        return path.stat().st_ino if path.exists() else None

    def refuse(self, path):
        number = self.number(path)
        if self.held.get(number, 0) > 0:
            self.held[number] -= 1
            raise PermissionError(13, "a scanner reads it", str(path))

    def replace(self, path, target):
        self.refuse(path)
        self.refuse(Path(target))
        if self.number(Path(target)) in self.mapped and path != target:
            raise PermissionError(13, "it is mapped", str(target))
        return plain_replace(path, target)

    def rename(self, path, target):
        self.refuse(path)
        if Path(target).exists() and path != target:
            raise FileExistsError(17, "is there", str(target))
        return plain_rename(path, target)

    def unlink(self, path, missing_ok=False):
        self.refuse(path)
        if self.number(path) in self.mapped:
            raise PermissionError(13, "it is mapped", str(path))
        plain_unlink(path, missing_ok)


@pytest.fixture
def windows(monkeypatch):
    pretence = Windows()
    for name in ("replace", "rename", "unlink"):
        call = getattr(pretence, name)
        monkeypatch.setattr(Path, name, lambda path, *a, _call=call, **k: _call(path, *a, **k))
    return pretence


@pytest.fixture
def old(tmp_path):
    path = tmp_path / "cube.npz"
    path.write_text("old")
    return path


@pytest.fixture
def new(tmp_path):
    path = tmp_path / "new"
    path.write_text("new")
    return path


def ends(folder):
    return sorted(path.suffix.removeprefix(".") for path in folder.iterdir())


def test_what_is_mapped_is_replaced_and_goes_when_it_is_let_go(windows, old, tmp_path):
    number = windows.number(old)
    windows.mapped.add(number)
    for content in (b"first", b"second"):
        with atomic_file(old) as file:
            file.write(content)
        assert old.read_bytes() == content
        (aside,) = tmp_path.glob(f".*.{REPLACED}")
        assert aside.read_text() == "old"
    windows.mapped.clear()
    with atomic_file(tmp_path / "another.npz") as file:
        file.write(b"x")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["another.npz", "cube.npz"]


def test_what_is_mapped_loses_its_name_when_it_is_removed(windows, old, tmp_path):
    windows.mapped.add(windows.number(old))
    discard(old)
    assert ends(tmp_path) == [REMOVED]
    sweep_aside(tmp_path)
    assert ends(tmp_path) == [REMOVED]
    windows.mapped.clear()
    sweep_aside(tmp_path)
    assert ends(tmp_path) == []


@pytest.mark.parametrize("which", ["old", "new"])
@pytest.mark.parametrize("is_mapped", [False, True])
@pytest.mark.parametrize("times", [1, 2, len(PAUSES)])
def test_a_scanner_is_waited_for(windows, old, new, which, is_mapped, times):
    if is_mapped:
        windows.mapped.add(windows.number(old))
    windows.held[windows.number(old if which == "old" else new)] = times
    slept = []
    take_place(new, old, slept.append)
    assert slept == list(PAUSES[: len(slept)])
    assert old.read_text() == "new"
    assert not new.exists()


@pytest.mark.parametrize("which", ["old", "new"])
@pytest.mark.parametrize("is_mapped", [False, True])
def test_who_is_never_let_go_leaves_both_as_they_were(windows, old, new, which, is_mapped):
    if is_mapped:
        windows.mapped.add(windows.number(old))
    windows.held[windows.number(old if which == "old" else new)] = 1000
    with pytest.raises(PermissionError):
        take_place(new, old, lambda _: None)
    assert (old.read_text(), new.read_text()) == ("old", "new")
    assert len(list(old.parent.iterdir())) == 2


def test_a_scanner_that_stays_is_told_by_name_and_reason(windows, old, monkeypatch):
    monkeypatch.setattr(patience, "PAUSES", ())
    windows.held[windows.number(old)] = 1000
    with (
        pytest.raises(UnwritableError, match=r"cube\.npz.*a scanner reads it"),
        atomic_file(old) as file,
    ):
        file.write(b"new")
    assert [path.name for path in old.parent.iterdir()] == ["cube.npz"]


def test_who_was_killed_between_two_names_leaves_the_older_file(old, tmp_path):
    old.rename(tmp_path / f".cube.npz.01234567.{REPLACED}")
    sweep_aside(tmp_path)
    assert old.read_text() == "old"
    assert ends(tmp_path) == ["npz"]


def test_nothing_else_is_swept(tmp_path):
    names = [f".cube.npz.0123456.{REMOVED}", f"cube.01234567.{REMOVED}", f".{REMOVED}", ".x.tmp"]
    for name in names:
        (tmp_path / name).write_text("kept")
    sweep_aside(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)


def test_what_is_not_there_needs_no_removal(tmp_path):
    discard(tmp_path / "nothing")
    assert list(tmp_path.iterdir()) == []
