"""Checks of a library for Windows."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import lief
from servo_wheel.target import Target

MACHINES = {"win_amd64": "AMD64", "win_arm64": "ARM64"}
# What comes with Windows 10 and with Blender; in small letters, without .dll.
SYSTEM = re.compile(
    r"api-ms-win-.*|advapi32|avrt|bcrypt|bcryptprimitives|cfgmgr32|kernel32|ntdll|ole32|psapi"
    r"|setupapi|ucrtbase|userenv|user32|winmm|ws2_32|msvcrt"
)


def faults(image: bytes, target: Target) -> Iterator[str]:
    """Yield the faults of an image."""
    library: Any = lief.PE.parse(image)
    if library is None:
        yield "it is no PE image"
        return
    if library.header.machine.name != MACHINES[target.tag]:
        yield f"it is compiled for {library.header.machine.name}"
    if "PyInit_palpate_servo" not in {entry.name for entry in library.get_export().entries}:
        yield "Python could not import it: no PyInit_palpate_servo"
    wanted = {entry.name.lower().removesuffix(".dll") for entry in library.imports}
    wanted |= {entry.name.lower().removesuffix(".dll") for entry in library.delay_imports}
    if "python3" not in wanted:
        yield "it does not load python3.dll, so it is of one Python only"
    foreign = sorted(name for name in wanted - {"python3"} if not SYSTEM.fullmatch(name))
    if foreign:
        yield f"it wants libraries that Windows does not have: {', '.join(foreign)}"
