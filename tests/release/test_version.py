"""The version stands in several files, and is told and set as one."""

import shutil
import tomllib

import pytest
from version import CHANGES, PLACES, REPOSITORY, main, version


@pytest.fixture
def copy(tmp_path):
    for place in (*PLACES, CHANGES):
        (tmp_path / place.file).parent.mkdir(exist_ok=True)
        shutil.copy(REPOSITORY / place.file, tmp_path / place.file)
    return tmp_path


def test_every_place_says_the_same():
    told = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    assert version() == told["project"]["version"]


def test_it_is_set_everywhere_and_nothing_else_changes(copy, capsys):
    before = {place.file: (copy / place.file).read_bytes() for place in PLACES}
    now, wanted = version(copy).encode(), b"12.34.56"
    changes = copy / CHANGES.file
    changes.write_text(f"# Changes\n\n## 12.34.56\n\n{changes.read_text(encoding='utf-8')}")
    assert main([wanted.decode()], copy) == 0
    assert capsys.readouterr().out == "12.34.56\n"
    for file, old in before.items():
        lines = zip(old.splitlines(), (copy / file).read_bytes().splitlines(), strict=True)
        assert [(a.replace(now, wanted), b) for a, b in lines if a != b] == [
            (b'version = "12.34.56"',) * 2
        ]


@pytest.mark.parametrize("place", [*PLACES, CHANGES], ids=lambda place: place.file)
def test_a_place_that_says_another_is_named(copy, capsys, place):
    place.set(copy, "9.9.9")
    assert main([], copy) == 2
    assert f"{place.file}: 9.9.9" in capsys.readouterr().err


def test_changes_that_are_not_told_and_versions_that_are_none_are_refused(copy, capsys):
    assert main(["12.34.56"], copy) == 2
    assert "CHANGELOG.md" in capsys.readouterr().err
    assert main(["next"], copy) == 2
    assert "three numbers" in capsys.readouterr().err
