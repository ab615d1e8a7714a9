"""Checks of a library for Windows."""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from typing import Any

import lief
from servo_wheel.target import Target

MACHINES = {"win_amd64": "AMD64", "win_arm64": "ARM64"}
# What comes with Windows 10 and with Blender; in small letters, without .dll.
SYSTEM = re.compile(
    r"api-ms-win-.*|advapi32|avrt|bcrypt|bcryptprimitives|cfgmgr32|kernel32|ntdll|ole32|psapi"
    r"|iphlpapi|msvcrt|pdh|powrprof|setupapi|shell32|ucrtbase|userenv|user32|winmm|ws2_32"
)

# Of an image's first head, where it says where the second is.
PLACE_OF_HEAD = 60


def faults(image: bytes, target: Target) -> Iterator[str]:
    """Yield the faults of an image."""
    library: Any = lief.PE.parse(image)
    if library is None:
        yield "it is no PE image"
        return
    if library.header.machine.name != MACHINES[target.tag]:
        yield f"it is compiled for {library.header.machine.name}"
    if not holds_a_program(image):
        yield "the guardian is not in it"
    if "PyInit_palpate_servo" not in {entry.name for entry in library.get_export().entries}:
        yield "Python could not import it: no PyInit_palpate_servo"
    wanted = {entry.name.lower().removesuffix(".dll") for entry in library.imports}
    wanted |= {entry.name.lower().removesuffix(".dll") for entry in library.delay_imports}
    if "python3" not in wanted:
        yield "it does not load python3.dll, so it is of one Python only"
    foreign = sorted(name for name in wanted - {"python3"} if not SYSTEM.fullmatch(name))
    if foreign:
        yield f"it wants libraries that Windows does not have: {', '.join(foreign)}"


def holds_a_program(image: bytes) -> bool:
    """Tell whether another image lies within this one: a head that says where its other head is."""
    starts = [found.start() for found in re.finditer(b"MZ", image)]
    heads = [
        start + struct.unpack_from("<I", image, start + PLACE_OF_HEAD)[0]
        for start in starts
        if 0 < start < len(image) - PLACE_OF_HEAD - 4
    ]
    return any(image[head : head + 4] == b"PE\0\0" for head in heads)
