"""A .blend file that a command opens and saves."""

from pathlib import Path

import bpy

from ..core.errors import PalpateError


def opened_object(file: Path, name: str) -> bpy.types.Object:
    """Open a file and find an object in it.

    Raises
    ------
    PalpateError
        No such file, none that Blender can open, or no such object.
    """
    if not file.is_file():
        raise PalpateError(f"{file}: there is no such file; give the path of a .blend")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(file.resolve()), load_ui=False)
    except RuntimeError as problem:
        reason = str(problem).strip().removeprefix("Error: ")
        raise PalpateError(
            f"{file}: Blender cannot open it ({reason}); give a .blend file"
        ) from problem
    thing = bpy.data.objects.get(name)
    if thing is None:
        meshes = ", ".join(o.name for o in bpy.data.objects if o.type == "MESH") or "none"
        raise PalpateError(f"{file}: it has no object '{name}'; its mesh objects: {meshes}")
    return thing


def save(file: Path) -> None:
    """Save what is open in a file; PalpateError where Blender cannot."""
    try:
        bpy.ops.wm.save_mainfile(filepath=str(file.resolve()))
    except RuntimeError as problem:
        raise PalpateError(
            f"{file}: Blender cannot save it ({str(problem).strip()}); choose a folder you may "
            "write to"
        ) from problem
