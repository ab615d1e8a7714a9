"""The Blenders that packages are made for, read from the table `release/blenders.mk`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

TABLE = Path(__file__).with_name("blenders.mk")


@dataclass(frozen=True)
class Blender:
    """One Blender: its version, the Python within it, and the platforms that it is built for."""

    version: str
    python: str
    platforms: tuple[str, ...]


@cache
def blenders() -> tuple[Blender, ...]:
    """Return every Blender of the table, oldest first."""
    rows = re.findall(r"^(\w[\w.]*) := (.*)$", TABLE.read_text(encoding="utf-8"), re.MULTILINE)
    value = dict(rows)
    return tuple(
        Blender(version, value[f"PYTHON_OF_{version}"], tuple(systems.split()))
        for version in value["BLENDERS"].split()
        for systems in [value[f"SYSTEMS_OF_{version}"]]
    )


def pythons_on(platform: str) -> list[str]:
    """Return the Pythons of the Blenders for a platform, such as `["3.11", "3.13"]`."""
    return list(
        dict.fromkeys(blender.python for blender in blenders() if platform in blender.platforms)
    )
