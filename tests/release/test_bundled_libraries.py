"""A bundled library that a user's system could not load is found before it is packed."""

from __future__ import annotations

import io
import zipfile
from types import SimpleNamespace

import bundled_libraries
import pytest
from platforms import PLATFORMS

WINDOWS, MACOS = PLATFORMS["windows-x64"], PLATFORMS["macos-arm64"]
LINUX = PLATFORMS["linux-x64"]


def wheel(*names):
    """A wheel with files of these names."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name in names:
            archive.writestr(name, b"an image")
    return content.getvalue()


def named(*names):
    return [SimpleNamespace(name=name) for name in names]


@pytest.fixture
def windows(monkeypatch):
    """Every image for Windows asks for these libraries."""

    def asks(*names, late=()):
        image = SimpleNamespace(imports=named(*names), delay_imports=named(*late))
        monkeypatch.setattr(bundled_libraries.lief.PE, "parse", lambda _: image)

    return asks


@pytest.fixture
def macos(monkeypatch):
    """Every image for macOS is of this processor, asks for these libraries and is signed so."""

    def asks(processor, *names, unsigned=None):
        header = SimpleNamespace(cpu_type=SimpleNamespace(name=processor))
        part = SimpleNamespace(header=header, fat_offset=0, libraries=named(*names))
        monkeypatch.setattr(bundled_libraries.lief.MachO, "parse", lambda _: [part])
        monkeypatch.setattr(bundled_libraries, "signature_fault", lambda _: unsigned)

    return asks


def test_what_windows_blender_and_the_wheel_have_is_no_fault(windows):
    windows("KERNEL32.dll", "python311.dll", "VCRUNTIME140_1.dll", "msvcp140-8f1.dll")
    content = wheel("a/a.pyd", "a.libs/msvcp140-8f1.dll")
    assert list(bundled_libraries.of_wheel(content, WINDOWS)) == []


def test_what_is_loaded_before_need_not_be_beside(windows):
    windows("VCOMP140.dll")
    ours = frozenset({"vcomp140"})
    for name, has, count in (("lib_coacd", ours, 0), ("lib_coacd", frozenset(), 1), ("a", ours, 1)):
        found = bundled_libraries.of_wheel(wheel(f"coacd/{name}.dll"), WINDOWS, has)
        assert len(list(found)) == count


@pytest.mark.parametrize("name", ["MSVCP140.dll", "python312.dll", "vcomp140.dll"])
def test_what_nobody_has_is_told(windows, name):
    windows("KERNEL32.dll", late=[name])
    (fault,) = bundled_libraries.of_wheel(wheel("a/a.pyd"), WINDOWS)
    assert fault == f"a/a.pyd asks for {name.lower()}, which neither Windows nor Blender has"


@pytest.mark.parametrize(("length", "count"), [(135, 0), (136, 1)])
def test_a_path_that_windows_cuts_is_told(length, count):
    content = wheel("a/" + "b" * (length - 2))
    assert len(list(bundled_libraries.of_wheel(content, WINDOWS))) == count
    assert list(bundled_libraries.of_wheel(content, MACOS)) == []


@pytest.fixture
def linux(monkeypatch):
    """Every image for Linux asks for these versions and libraries."""

    def asks(*versions, libraries=()):
        needed = SimpleNamespace(get_auxiliary_symbols=lambda: named(*versions))
        image = SimpleNamespace(symbols_version_requirement=[needed], libraries=list(libraries))
        monkeypatch.setattr(bundled_libraries.lief.ELF, "parse", lambda _: image)

    return asks


def test_what_glibc_2_28_and_the_wheel_have_is_no_fault(linux):
    libraries = ["libc.so.6", "libstdc++.so.6", "ld-linux-x86-64.so.2", "libgomp-1a.so.1.0.0"]
    linux("GLIBC_2.28", "GLIBC_2.2.5", "GLIBCXX_3.4.25", "GOMP_4.5", libraries=libraries)
    content = wheel("a/a.abi3.so", "a.libs/libgomp-1a.so.1.0.0", "a/a.so.txt")
    assert list(bundled_libraries.of_wheel(content, LINUX)) == []


@pytest.mark.parametrize("version", ["GLIBC_2.29", "GLIBCXX_3.4.26", "CXXABI_1.3.12"])
def test_a_library_made_on_a_newer_linux_is_told(linux, version):
    linux("GLIBC_2.17", version)
    (fault,) = bundled_libraries.of_wheel(wheel("a/a.so.1"), LINUX)
    assert version in fault


def test_a_library_that_not_every_linux_has_is_told(linux):
    linux(libraries=["libc.so.6", "libgomp.so.1"])
    (fault,) = bundled_libraries.of_wheel(wheel("a/a.so"), LINUX)
    assert "libgomp.so.1" in fault


def test_who_compiles_the_servo_for_a_newer_linux_may(linux, tmp_path):
    linux("GLIBC_2.34")
    package = tmp_path / "package.zip"
    with zipfile.ZipFile(package, "w") as archive:
        for name in ("palpate_servo-1-manylinux_2_34_x86_64", "a-1-manylinux_2_28_x86_64"):
            archive.writestr(f"wheels/{name}.whl", wheel("a.so"))
    (fault,) = bundled_libraries.faults(package, LINUX)
    assert fault.startswith("a-1-")


def test_what_macos_and_the_wheel_have_is_no_fault(macos):
    macos("ARM64", "/usr/lib/libSystem.B.dylib", "@loader_path/.dylibs/libgmp.dylib")
    assert list(bundled_libraries.of_wheel(wheel("a.so", ".dylibs/libgmp.dylib"), MACOS)) == []


def test_a_library_of_the_makers_computer_is_told(macos):
    macos("ARM64", "/opt/homebrew/lib/libgmp.dylib")
    (fault,) = bundled_libraries.of_wheel(wheel("a.so"), MACOS)
    assert "a.so asks for /opt/homebrew/lib/libgmp.dylib" in fault


@pytest.mark.parametrize(("processor", "count"), [("ARM64", 1), ("X86_64", 0)])
def test_only_arm64_must_be_signed(macos, processor, count):
    macos(processor, unsigned="it is not signed")
    assert len(list(bundled_libraries.of_wheel(wheel("a.dylib"), MACOS))) == count


def test_a_packages_faults_name_wheel_and_library(windows, tmp_path):
    windows("cudart.dll")
    package = tmp_path / "package.zip"
    with zipfile.ZipFile(package, "w") as archive:
        archive.writestr("wheels/one-1-py3-none-win_amd64.whl", wheel("one/a.pyd", "one/b.py"))
        archive.writestr("__init__.py", "")
    (fault,) = bundled_libraries.faults(package, WINDOWS)
    assert fault.startswith("one-1-py3-none-win_amd64.whl: one/a.pyd asks for cudart.dll")
