"""Checks of a library for macOS."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import lief
import ziglang
from servo_wheel.code_signature import signature_fault
from servo_wheel.target import Target

# The head of a program of 64 bits: its magic number alone also stands in code that reads images.
PROGRAM = re.compile(b"\xcf\xfa\xed\xfe[\x07\x0c]\x00\x00\x01.{4}\x02\x00\x00\x00", re.DOTALL)
MACHINES = {"arm64": "ARM64", "x86_64": "X86_64"}


def faults(image: bytes, target: Target) -> Iterator[str]:
    """Yield the faults of an image, and of the guardian within it."""
    yield from of_one(image, target)
    if "_PyInit_palpate_servo" not in exported(image):
        yield "Python could not import it: no PyInit_palpate_servo"
    program = PROGRAM.search(image)
    if program is None:
        yield "the guardian is not in it"
    else:
        yield from (f"guardian: {fault}" for fault in of_one(image[program.start() :], target))


def of_one(image: bytes, target: Target) -> Iterator[str]:
    """Yield the faults that a library and a program may both have."""
    parsed: Any = lief.MachO.parse(list(image))
    if parsed is None:
        yield "it is no Mach-O image"
        return
    library = parsed.at(0)
    _, major, minor, machine = target.tag.split("_", 3)
    if library.header.cpu_type.name != MACHINES[machine]:
        yield f"it is compiled for {library.header.cpu_type.name}"
    if library.build_version.minos[:2] > [int(major), int(minor)]:
        yield f"it is made for macOS {library.build_version.minos} and later"
    unsigned = signature_fault(image)
    if unsigned and machine == "arm64":
        yield f"arm64 would not load it: {unsigned}"
    asked = [entry.name for entry in library.libraries][library.header.file_type.name == "DYLIB" :]
    foreign = [name for name in asked if not is_of_the_system(name)]
    if foreign:
        yield f"it wants libraries that macOS does not have: {', '.join(foreign)}"
    unknown = sorted(
        name
        for name in {symbol.name for symbol in library.imported_symbols}
        if name not in symbols_of_the_system() and not name.startswith(("_Py", "__Py"))
    )
    if unknown:
        yield f"libSystem does not have {', '.join(unknown)}"


def is_of_the_system(library: str) -> bool:
    """Tell whether macOS itself brings a library, by its path."""
    return library.startswith(("/usr/lib/", "/System/"))


def exported(image: bytes) -> set[str]:
    """Return the names that an image exports."""
    parsed: Any = lief.MachO.parse(list(image))
    return {symbol.name for symbol in parsed.at(0).exported_symbols} if parsed else set()


@cache
def symbols_of_the_system() -> frozenset[str]:
    """Return the symbols that Apple's libSystem has, by zig's list of them."""
    listed = Path(ziglang.__file__).parent / "lib" / "libc" / "darwin" / "libSystem.tbd"
    return frozenset(re.findall(r"[\w$.\-]+", listed.read_text(encoding="utf-8")))
