"""An OpenMP of one thread in the servo's wheel for Windows, which CoACD's library asks for.

Microsoft's own comes with its redistributable alone. The child that takes meshes apart loads this
one first (core/contact/tool/decomposition_child.py); it uses one thread on every system.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import lief
from bundled_wheels import PackagingError
from servo_wheel.target import Target
from servo_wheel.wheel_file import rewrite

SOURCE = "native/openmp/one_thread.c"
NAME = "palpate_servo/vcomp140.dll"
# What CoACD 1.0.14 asks for.
ASKED = {"_vcomp_fork", "_vcomp_for_static_simple_init", "_vcomp_for_static_end", "omp_get_wtime"}


def is_wanted(target: Target) -> bool:
    """Tell whether there is a CoACD for a target that asks for it."""
    return target.platform == "windows-x64"


def add_to(wheel: Path, repository: Path) -> None:
    """Compile it and lay it in a wheel.

    Raises
    ------
    PackagingError
        It does not compile.
    """
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / Path(NAME).name
        call = [sys.executable, "-m", "ziglang", "cc", "-target", "x86_64-windows-gnu", "-shared"]
        call += ["-O2", "-s", "-nostdlib", "-fno-sanitize=all", "-o", str(library)]
        call += [str(repository / SOURCE), "-lkernel32"]
        if subprocess.run(call, check=False, cwd=folder).returncode != 0:
            message = f"{SOURCE} does not compile"
            raise PackagingError(message)
        rewrite(wheel, {NAME: library.read_bytes()})


def faults(image: bytes) -> Iterator[str]:
    """Yield the faults of the library."""
    library: Any = lief.PE.parse(image)
    if library is None:
        yield f"{NAME} is no PE image"
        return
    missing = ASKED - {entry.name for entry in library.get_export().entries}
    if missing:
        yield f"{NAME} lacks {', '.join(sorted(missing))}"
    foreign = {entry.name.lower() for entry in library.imports} - {"kernel32.dll"}
    if foreign:
        yield f"{NAME} wants {', '.join(sorted(foreign))}"
