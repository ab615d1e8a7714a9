"""Where an object's body is kept: a file beside the .blend, and its tetrahedra inside the .blend.

The file holds the compliance and may be large. Should it be missing or damaged, the tetrahedra that
travel with the object make the same body again in seconds, without a new tetrahedralization.
"""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
import numpy as np

from ..core import cache
from ..core.bake import BakeSettings
from ..core.bake_job import run_bake
from ..core.cache import BodyFileError
from ..core.errors import PalpateError
from ..core.pins import PinNodes
from ..core.soft_body import SoftBody
from ..core.tet_mesh import TetMesh
from .package_preferences import PACKAGE, preferences

FOLDER = "palpate"
KEY_LETTERS = 12
EMBEDDED = ("nodes", "tets", "fixed")

# Files found damaged, and the time they had then: the panel offers to rebuild them.
_damaged: dict[Path, int] = {}


def file_name(thing: bpy.types.Object, key: str) -> str:
    """``<object>-<start of the key>.npz``."""
    return f"{bpy.path.clean_name(thing.name)}-{key[:KEY_LETTERS]}.npz"


def folder_for_new_files() -> Path:
    """Beside the saved .blend; before that the folder of the preferences, or the user's."""
    if bpy.data.filepath:
        return Path(bpy.data.filepath).parent / FOLDER
    return _unsaved_folder()


def _unsaved_folder() -> Path:
    chosen = preferences().body_folder
    if chosen:
        return Path(bpy.path.abspath(chosen))
    if PACKAGE.startswith("bl_ext."):
        return Path(bpy.utils.extension_path_user(PACKAGE, path="bodies", create=True))
    return Path(bpy.utils.user_resource("DATAFILES", path=FOLDER, create=True))


def locate(thing: bpy.types.Object) -> Path | None:
    """The object's body file, wherever it is among the known places."""
    name = thing.palpate.body_file
    if not name:
        return None
    places = [_unsaved_folder()]
    if bpy.data.filepath:
        places.insert(0, Path(bpy.data.filepath).parent / FOLDER)
    return next((place / name for place in places if (place / name).is_file()), None)


def load(thing: bpy.types.Object) -> SoftBody:
    """Read the object's body and make sure that it is this object's.

    Raises
    ------
    PalpateError
        Never baked.
    BodyFileError
        Missing, damaged, or the body of something else; Rebuild Body makes it again.
    """
    baked = thing.palpate
    if not baked.body_key:
        raise PalpateError(f"{thing.name}: it is not soft yet; press Make Soft first")
    path = locate(thing)
    if path is None:
        raise BodyFileError(
            f"{thing.name}: its body file '{baked.body_file}' is missing; press Rebuild Body"
        )
    try:
        body = cache.load(path)
    except BodyFileError:
        _damaged[path] = path.stat().st_mtime_ns
        raise
    if cache.body_key(body.mesh, body.fixed, body.poisson_ratio) != baked.body_key:
        _damaged[path] = path.stat().st_mtime_ns
        raise BodyFileError(
            f"{path}: it is the body of something else, not of {thing.name}; press Rebuild Body"
        )
    return body


def is_known_damaged(path: Path) -> bool:
    """Whether :func:`load` found this file damaged, and it has not been written since."""
    return path in _damaged and _damaged[path] == path.stat().st_mtime_ns


def restore(thing: bpy.types.Object) -> SoftBody:
    """Compute a missing body again from the tetrahedra in the .blend, and store its file.

    Waits: a second or two for a thousand free surface nodes.

    Raises
    ------
    PalpateError
        There are no tetrahedra, or they are not those of the body that was baked.
    """
    baked = thing.palpate
    mesh, pins = embedded(thing)
    ratio = round(baked.baked_poisson_ratio, 6)
    if cache.body_key(mesh, pins.nodes, ratio) != baked.body_key:
        raise PalpateError(
            f"{thing.name}: the tetrahedra in this file are not those of its body; press Make Soft"
        )
    settings = BakeSettings(ratio, baked.young_modulus, pins)
    target = folder_for_new_files() / baked.body_file
    python = (sys.executable, *bpy.app.python_args)
    return run_bake(mesh, settings, target, python=python)[0]


def embed(thing: bpy.types.Object, body: SoftBody) -> None:
    """Put the tetrahedra into the .blend, on the object."""
    _remove_embedded(thing)
    thing.palpate["nodes"] = body.mesh.nodes.ravel()
    thing.palpate["tets"] = body.mesh.tets.astype(np.int32).ravel()
    thing.palpate["fixed"] = body.fixed.astype(np.int32)


def _remove_embedded(thing: bpy.types.Object) -> None:
    # Also before writing: overwriting an array property corrupts memory (Blender 4.5 to 5.2).
    for name in EMBEDDED:
        if name in thing.palpate:
            del thing.palpate[name]


def embedded(thing: bpy.types.Object) -> tuple[TetMesh, PinNodes]:
    """The tetrahedra and pins that travel with the object.

    Raises
    ------
    PalpateError
        There are none.
    """
    baked = thing.palpate
    if any(name not in baked for name in EMBEDDED):
        raise PalpateError(
            f"{thing.name}: there are no tetrahedra in this file to rebuild from; press Make Soft"
        )
    nodes, tets, fixed = (np.array(baked[name]) for name in EMBEDDED)
    return TetMesh.checked(nodes.reshape(-1, 3), tets.reshape(-1, 4)), PinNodes(
        fixed.astype(np.int64)
    )


def forget(thing: bpy.types.Object) -> None:
    """Remove the body: its file, unless another object uses it, and all that the object keeps."""
    name, path = thing.palpate.body_file, locate(thing)
    shared = any(o != thing and o.palpate.body_file == name for o in bpy.data.objects)
    if path is not None and not shared:
        path.unlink()
    _remove_embedded(thing)
    for setting in ("body_key", "body_file", "fingerprint"):
        thing.palpate.property_unset(setting)


def gather_beside(blend: Path, found: dict[str, Path], *, is_open_file: bool) -> None:
    """After a save: put the body files at ``found`` (by name) into the folder beside ``blend``.

    Files that lay in the user's folder because there was no .blend yet are moved, others copied.

    Raises
    ------
    BodyFileError
        The folder cannot be written.
    """
    folder = blend.parent / FOLDER
    for name, source in found.items():
        target = folder / name
        if target == source or target.is_file():
            continue
        cache.adopt(source, target)
        if is_open_file and source.parent == _unsaved_folder():
            source.unlink()
