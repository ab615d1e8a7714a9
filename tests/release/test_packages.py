"""Packages are whole or not made at all."""

from __future__ import annotations

import re
import tomllib
import zipfile
from pathlib import Path

import pytest
from blenders import blenders, pythons_on
from build_extension import main
from bundled_wheels import LOCKS, PackagingError, lock_file, pinned_for, pins
from extension_files import extension_files
from package_check import faults, needed_on, runs_on
from package_manifest import package_manifest
from platforms import PLATFORMS
from reproducible_zip import settle

REPOSITORY = Path(__file__).resolve().parents[2]
MANIFEST = (REPOSITORY / "blender_manifest.toml").read_text(encoding="utf-8")
LINUX = PLATFORMS["linux-x64"]
EVERYWHERE = {"pyserial", "threadpoolctl"}
WHOLE = [
    "scipy-1.17.1-cp311-cp311-manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl",
    "scipy-1.18.1-cp313-cp313-manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl",
    "pytetwild-0.2.3-cp311-cp311-manylinux2014_x86_64.manylinux_2_17_x86_64.whl",
    "pytetwild-0.2.3-cp312-abi3-manylinux2014_x86_64.manylinux_2_17_x86_64.whl",
    "fast_simplification-0.2.0-cp311-cp311-manylinux_2_28_x86_64.whl",
    "fast_simplification-0.2.0-cp313-cp313-manylinux_2_28_x86_64.whl",
    "coacd-1.0.14-cp39-abi3-manylinux_2_17_x86_64.manylinux2014_x86_64.whl",
    "psutil-7.2.2-cp36-abi3-manylinux2010_x86_64.manylinux_2_12_x86_64.manylinux_2_28_x86_64.whl",
    "pyserial-3.5-py2.py3-none-any.whl",
    "threadpoolctl-3.8.0-py3-none-any.whl",
    "palpate_servo-0.1.0-cp311-abi3-manylinux_2_28_x86_64.whl",
]


def make_package(folder, wheels, extra=()):
    """Write a zip that looks like a package for Linux."""
    path = folder / "package.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("blender_manifest.toml", package_manifest(MANIFEST, "linux-x64", wheels))
        for name in ("__init__.py", *(f"wheels/{wheel}" for wheel in wheels), *extra):
            archive.writestr(name, "")
    return path


@pytest.mark.parametrize(
    ("wheel", "version", "fits"),
    [
        ("scipy-1.17.1-cp311-cp311-win_amd64.whl", "3.11", True),
        ("scipy-1.17.1-cp311-cp311-win_amd64.whl", "3.13", False),
        ("pytetwild-0.2.3-cp312-abi3-win_amd64.whl", "3.11", False),
        ("pytetwild-0.2.3-cp312-abi3-win_amd64.whl", "3.13", True),
        ("palpate_servo-0.1.0-cp311-abi3-win_amd64.whl", "3.14", True),
        ("pyserial-3.5-py2.py3-none-any.whl", "3.13", True),
        ("ancient-1.0-py2-none-any.whl", "3.13", False),
    ],
)
def test_a_wheels_name_says_which_python_it_runs_on(wheel, version, fits):
    assert runs_on(wheel, version) is fits


@pytest.mark.parametrize(
    ("wheel", "platform"),
    [
        ("a-1-cp311-cp311-manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl", "linux-x64"),
        ("a-1-cp311-cp311-win_amd64.whl", "windows-x64"),
        ("a-1-cp311-cp311-win_arm64.whl", "windows-arm64"),
        ("a-1-cp311-cp311-manylinux_2_28_aarch64.whl", "linux-arm64"),
        ("a-1-cp311-cp311-macosx_11_0_arm64.whl", "macos-arm64"),
        ("a-1-cp311-cp311-macosx_10_15_x86_64.whl", "macos-x64"),
    ],
)
def test_a_wheels_name_says_which_system_it_runs_on(wheel, platform):
    assert [name for name, other in PLATFORMS.items() if other.runs(wheel)] == [platform]


def test_a_whole_package_has_no_faults(tmp_path):
    assert faults(make_package(tmp_path, WHOLE), LINUX, ["3.11", "3.13"]) == []


@pytest.mark.parametrize("missing", WHOLE)
def test_every_wheel_is_missed(tmp_path, missing):
    wheels = [wheel for wheel in WHOLE if wheel != missing]
    found = faults(make_package(tmp_path, wheels), LINUX, ["3.11", "3.13"])
    assert any(missing.split("-")[0] in sentence for sentence in found)


@pytest.mark.parametrize(
    ("extra", "complaint"),
    [
        ("wheels/numpy-2.2.0-cp313-cp313-manylinux_2_28_x86_64.whl", "numpy is Blender's own"),
        ("wheels/scipy-1.18.1-cp313-cp313-win_amd64.whl", "another platform"),
        ("tests/core/test_bake.py", "does not belong"),
        ("native/src/lib.rs", "does not belong"),
    ],
)
def test_what_does_not_belong_is_found(tmp_path, extra, complaint):
    found = faults(make_package(tmp_path, WHOLE, [extra]), LINUX, ["3.11", "3.13"])
    assert any(complaint in sentence for sentence in found)


def test_the_packages_manifest_differs_from_the_sources_only_where_it_must():
    before = tomllib.loads(MANIFEST)
    after = tomllib.loads(package_manifest(MANIFEST, "windows-x64", ["b.whl", "a.whl"]))
    assert after.pop("wheels") == ["./wheels/a.whl", "./wheels/b.whl"]
    assert after.pop("platforms") == ["windows-x64"]
    assert set(before.pop("platforms")) == set(PLATFORMS)
    assert after == before


def test_a_manifest_that_lists_wheels_itself_is_refused():
    with pytest.raises(PackagingError, match="no wheels"):
        package_manifest('wheels = ["./a.whl"]\n' + MANIFEST, "linux-x64", [])


def test_a_package_without_the_servo_is_refused(tmp_path, capsys):
    status = main(["--platform", "macos-arm64", "--blender", str(tmp_path)])
    assert status == 2
    assert "cannot press" in capsys.readouterr().err


def test_a_servo_for_another_platform_is_refused(tmp_path, capsys):
    wheel = tmp_path / WHOLE[-1]
    wheel.touch()
    command = ["--platform", "windows-x64", "--blender", str(tmp_path), "--servo-wheel", str(wheel)]
    assert main(command) == 2
    assert "not a palpate_servo wheel for windows-x64" in capsys.readouterr().err


@pytest.mark.parametrize("version", ["3.11", "3.13"])
def test_every_bundled_wheel_is_pinned_with_a_hash_for_each_platform_that_has_it(version):
    entries = pins(version)
    assert len(entries) == 7
    platforms = [one for one in PLATFORMS.values() if version in pythons_on(one.name)]
    for pin, entry in entries.items():
        name = pin.split("==")[0]
        builds = sum(name not in one.without for one in platforms)
        # These two are the same file everywhere.
        assert entry.count("--hash=sha256:") == (1 if name in EVERYWHERE else builds), pin
    assert "pytetwild==0.2.3" in entries
    assert "numpy" not in {pin.split("==")[0] for pin in entries}


def test_what_nobody_builds_for_a_platform_is_neither_fetched_nor_missed():
    arm = PLATFORMS["linux-arm64"]
    assert set(pins("3.11")) - set(pinned_for(arm, "3.11")) == {"pytetwild==0.2.3"}
    assert "pytetwild" not in needed_on(arm)
    assert "pytetwild" in needed_on(LINUX)
    windows = PLATFORMS["windows-arm64"]
    assert not {"pytetwild", "fast_simplification"} & set(needed_on(windows))


def test_a_python_without_a_list_of_wheels_says_which_there_are():
    with pytest.raises(PackagingError, match=r"3\.99 .*cp311"):
        lock_file("3.99")
    assert LOCKS.is_dir()


def test_a_file_that_nobody_foresaw_is_not_shipped(tmp_path):
    folders = ("addon", "operators", "core", "simulated", "cli")
    for name in ("__init__.py", "LICENSE", *(f"{folder}/a.py" for folder in folders)):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    assert len(extension_files(tmp_path)) == 7
    (tmp_path / "core" / "notes.txt").touch()
    with pytest.raises(PackagingError, match=r"core/notes\.txt"):
        extension_files(tmp_path)


def test_the_bytes_of_a_package_follow_from_its_contents_alone(tmp_path):
    written = []
    for number, names in enumerate((["b.py", "a.whl"], ["a.whl", "b.py"])):
        path = tmp_path / f"{number}.zip"
        with zipfile.ZipFile(path, "w") as archive:
            for name in names:
                entry = zipfile.ZipInfo(name, (2020 + number, 1, 1, 0, 0, 0))
                entry.external_attr = (0o100600 + number) << 16
                archive.writestr(entry, name * 100)
        settle(path)
        written.append(path.read_bytes())
        with zipfile.ZipFile(path) as archive:
            assert archive.read("b.py") == b"b.py" * 100
            assert archive.testzip() is None
    assert written[0] == written[1]


def test_the_table_of_blenders_names_platforms_that_there_are():
    assert [one.version for one in blenders()] == sorted(one.version for one in blenders())
    assert {name for one in blenders() for name in one.platforms} == set(PLATFORMS)
    assert pythons_on("linux-x64") == ["3.11", "3.13"]
    assert pythons_on("macos-x64") == ["3.11"]


def test_the_workflow_tries_the_blenders_of_the_table():
    text = (REPOSITORY / ".github" / "workflows" / "packages.yml").read_text(encoding="utf-8")
    tried = re.findall(r'{ bpy: ([\d.]+), python: "([\d.]+)" }', text)
    assert tried == [(one.version, one.python) for one in blenders()]
