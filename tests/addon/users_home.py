"""A user's home beside a stranger's .blend, and what of it a test has touched."""

from __future__ import annotations

import os
from pathlib import Path

import bpy
from soft_scene import select, soft_cube

KEY = "0123456789ab"


def fill_home(folder: Path) -> None:
    """Put things that are nobody's business into a home in this folder."""
    for place in (".ssh/id_rsa", "letter.odt", f"body-{KEY}.npz", ".config/autostart/here.desktop"):
        path = folder / "home" / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"the user's {place}")


def save_soft_cube(folder: Path) -> bpy.types.Object:
    """A soft cube, saved as scene/scene.blend in this folder, with its body beside it."""
    thing = soft_cube()
    (folder / "scene").mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene" / "scene.blend"))
    return select(thing)


def everything(folder: Path) -> dict[Path, bytes]:
    """All files below a folder, links not followed."""
    found = (Path(top) / name for top, _, names in os.walk(folder) for name in names)
    return {path: b"link" if path.is_symlink() else path.read_bytes() for path in found}


def outside(folder: Path) -> dict[Path, bytes]:
    """All files but the .blend files and what lies in the folders of bodies."""
    own = {path for path in folder.rglob("palpate") if path.is_dir() and not path.is_symlink()}
    return {
        path: held
        for path, held in everything(folder).items()
        if path.parent not in own and path.suffix not in {".blend", ".blend1"}
    }
