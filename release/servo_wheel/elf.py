"""Checks of a library for Linux."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from servo_wheel.target import Target

# Of 64 bits, little endian; the first four bytes alone also stand in code that reads images.
MAGIC = b"\x7fELF\x02\x01\x01"


def faults(image: bytes, _target: Target) -> Iterator[str]:
    """Yield the faults of an image."""
    if not image.startswith(MAGIC):
        yield "it is no ELF image"
    if b"PyInit_palpate_servo" not in image:
        yield "Python could not import it: no PyInit_palpate_servo"
    if image.find(MAGIC, 1) < 0:
        yield "the guardian is not in it"


def faults_of_wheel(wheel: Path, target: Target) -> list[str]:
    """Return what auditwheel says against a wheel's tag: versions of glibc, foreign libraries."""
    done = subprocess.run(
        [sys.executable, "-m", "auditwheel", "show", str(wheel)],
        check=False,
        capture_output=True,
        text=True,
    )
    fits = re.search(r'platform\s+tag:\s+"([\w.]+)"', done.stdout)
    if fits is None:
        return [f"auditwheel: {done.stdout}{done.stderr}".strip()]
    if minor(fits[1]) > minor(target.tag):
        return [f"auditwheel: it needs {fits[1]}"]
    return []


def minor(tag: str) -> int:
    """Return the 28 of `manylinux_2_28_x86_64`; a large number for a tag of no glibc."""
    match = re.match(r"manylinux_2_(\d+)_", tag)
    return int(match[1]) if match else 999
