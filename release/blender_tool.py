"""Blender's own extension tool, `blender_ext.py`, which lies inside every Blender and bpy wheel."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

from bundled_wheels import PackagingError

if TYPE_CHECKING:
    from pathlib import Path


def find_tool(under: Path) -> Path:
    """Return the path of blender_ext.py below a folder that holds a Blender or a bpy module."""
    found = sorted(under.rglob("scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    if not found:
        message = (
            f"no Blender with an extension tool below {under}: install bpy there (`make setup`)"
        )
        raise PackagingError(message)
    return found[-1]


def build(tool: Path, source: Path, package: Path) -> None:
    """Make the zip `package` from the staged folder `source`."""
    _run(tool, "build", "--source-dir", str(source), "--output-filepath", str(package))


def validate(tool: Path, package: Path) -> None:
    """Let Blender check a package as it would when installing it, tags too."""
    _run(tool, "validate", str(package))


def _run(tool: Path, *arguments: str) -> None:
    done = subprocess.run(
        [sys.executable, str(tool), *arguments], check=False, capture_output=True, text=True
    )
    if done.returncode != 0:
        message = f"blender_ext.py {arguments[0]} failed:\n{done.stdout}{done.stderr}"
        raise PackagingError(message)
