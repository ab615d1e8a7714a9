"""What can be known of a wheel without the system that it is for."""

from __future__ import annotations

import re
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

from servo_wheel import elf, mach_o, openmp, pe
from servo_wheel.target import Target

HOME = str(Path.home()).encode()


def faults(wheel: Path, target: Target) -> list[str]:
    """Return one sentence for each fault of a compiled wheel; none for a sound one."""
    image = native_image(wheel)
    found = [*_of_name(wheel, target), *_of_abi(wheel), *of_image(image, target)]
    if target.is_linux:
        found += elf.faults_of_wheel(wheel, target)
    if openmp.is_wanted(target):
        with zipfile.ZipFile(wheel) as archive:
            found += openmp.faults(archive.read(openmp.NAME))
    return found


def native_image(wheel: Path) -> bytes:
    """Return the one shared library within a wheel."""
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith((".so", ".pyd"))]
        return archive.read(name)


def of_image(image: bytes, target: Target) -> list[str]:
    """Return the faults of a shared library."""
    of_system = mach_o if target.is_macos else elf if target.is_linux else pe
    found = list(of_system.faults(image, target))
    if HOME in image and HOME != b"/":
        found.append("it holds paths of the machine that compiled it")
    return found


def _of_name(wheel: Path, target: Target) -> Iterator[str]:
    if not wheel.stem.endswith(f"-abi3-{target.tag}"):
        yield f"it is tagged for something else than {target.tag}"


def _of_abi(wheel: Path) -> Iterator[str]:
    """What it wants of Python is in the stable ABI of the version that it is tagged for."""
    done = subprocess.run(
        [sys.executable, "-m", "abi3audit", "--strict", "--summary", str(wheel)],
        check=False,
        capture_output=True,
        text=True,
    )
    said = f"{done.stdout}{done.stderr}"
    if done.returncode != 0 or not re.search(r"\b0 ABI version mismatches", said):
        yield f"abi3audit: {said.strip()}"
