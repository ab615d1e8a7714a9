"""What the libraries in a package's wheels ask of their system, read as its loader would.

Wheels of others are bundled unmodified. What their makers' computers had, a user's may not have.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import lief
from platforms import Platform
from servo_wheel import openmp
from servo_wheel.code_signature import signature_fault
from servo_wheel.mach_o import is_of_the_system
from servo_wheel.pe import SYSTEM

# Beside Blender's python.exe or, of the C runtime, shown to it by core/machine/c_runtime.py. Not
# the C++ runtime (msvcp140): that of Blender 4.5 and 5.0 is of 2021, too old for newer compilers.
BLENDERS = frozenset({"python3", "python311", "python313", "vcruntime140", "vcruntime140_1"})

# What is loaded before, from the servo's wheel (decomposition_child.py).
LOADED_BEFORE = {"coacd/lib_coacd.dll": frozenset({Path(openmp.NAME).stem})}

# What Linux with glibc 2.28 has, as Debian 10 and Red Hat 8: newest versions of the symbols of its
# C library and of gcc 8's for C++, and the libraries that wheels may ask of it (PEP 600).
NEWEST = {"GLIBC": (2, 28), "GLIBCXX": (3, 4, 25), "CXXABI": (1, 3, 11)}
OF_LINUX = re.compile(
    r"(ld-linux-(x86-64|aarch64)|lib(c|m|dl|rt|util|pthread|resolv|gcc_s|stdc\+\+|z))\.so\.\d"
)

# Where Blender unpacks wheels on Windows, for a user with a long name, and what a path may hold.
UNPACKED = (
    "C:/Users/" + "x" * 20 + "/AppData/Roaming/Blender Foundation/Blender/5.2/extensions"
    "/.local/lib/python3.13/site-packages/"
)
LONGEST_PATH = 259


def faults(package: Path, platform: Platform) -> list[str]:
    """Return one sentence for each library that cannot be loaded where the package is installed.

    The servo for Linux goes by its tag, which auditwheel looks at: who compiles it for one computer
    may have a newer one.
    """
    own = "wheels/palpate_servo-" if platform.name.startswith("linux") else "-"
    with zipfile.ZipFile(package) as archive:
        names = archive.namelist()
        wheels = {
            Path(one).name: archive.read(one)
            for one in names
            if one.endswith(".whl") and not one.startswith(own)
        }
    servo = [one for name, one in wheels.items() if name.startswith("palpate_servo-")]
    ours = frozenset(Path(name).stem for one in servo for name in _names(one))
    return [
        f"{name}: {fault}"
        for name, content in wheels.items()
        for fault in of_wheel(content, platform, ours)
    ]


def _names(wheel: bytes) -> list[str]:
    with zipfile.ZipFile(io.BytesIO(wheel)) as archive:
        return archive.namelist()


def of_wheel(
    content: bytes, platform: Platform, ours: frozenset[str] = frozenset()
) -> Iterator[str]:
    """Yield what is wrong with the libraries of one wheel; ``ours`` lie in the servo's wheel."""
    with zipfile.ZipFile(io.BytesIO(content)) as wheel:
        images = {name: wheel.read(name) for name in wheel.namelist()}
    if platform.name.startswith("windows"):
        yield from (f"{name} has too long a path for Windows" for name in images if _is_long(name))
    names = frozenset(Path(name).name.lower() for name in images)
    for name, image in images.items():
        if name.endswith((".pyd", ".dll")):
            found = _of_windows(image, names, ours & LOADED_BEFORE.get(name, frozenset()))
        elif name.endswith((".so", ".dylib")) and platform.name.startswith("macos"):
            found = _of_macos(image, names)
        elif re.search(r"\.so(\.\d+)*$", name) and platform.name.startswith("linux"):
            found = _of_linux(image, names)
        else:
            continue
        yield from (f"{name} {fault}" for fault in found)


def _is_long(name: str) -> bool:
    return len(UNPACKED) + len(name) > LONGEST_PATH


def _of_windows(image: bytes, beside: frozenset[str], before: frozenset[str]) -> Iterator[str]:
    library: Any = lief.PE.parse(image)
    asked = {entry.name.lower() for entry in (*library.imports, *library.delay_imports)}
    for name in sorted(asked - beside):
        stem = name.removesuffix(".dll")
        if stem not in BLENDERS | before and not SYSTEM.fullmatch(stem):
            yield f"asks for {name}, which neither Windows nor Blender has"


def _of_linux(image: bytes, beside: frozenset[str]) -> Iterator[str]:
    library: Any = lief.ELF.parse(list(image))
    versions = {
        version.name
        for needed in library.symbols_version_requirement
        for version in needed.get_auxiliary_symbols()
    }
    for version in sorted(versions):
        name, _, number = version.partition("_")
        parts = tuple(int(part) for part in number.split(".") if part.isdecimal())
        if parts > NEWEST.get(name, parts):
            yield f"asks for {version}, which Linux with glibc 2.28 does not have"
    for name in sorted(library.libraries):
        if name.lower() not in beside and not OF_LINUX.fullmatch(name):
            yield f"asks for {name}, which not every Linux has"


def _of_macos(image: bytes, beside: frozenset[str]) -> Iterator[str]:
    """A file may hold an image for each processor; whether it is signed matters to one."""
    parts: Any = lief.MachO.parse(list(image))
    for part in parts:
        unsigned = signature_fault(image[part.fat_offset :])
        if part.header.cpu_type.name == "ARM64" and unsigned:
            yield f"is not loaded by arm64: {unsigned}"
        for entry in part.libraries:
            if not is_of_the_system(entry.name) and Path(entry.name).name.lower() not in beside:
                yield f"asks for {entry.name}, which macOS does not have"
