"""Storage of an object's body: a file next to the .blend, and its tetrahedra inside the .blend.

The file holds the compliance and may be large. If it is missing or damaged, the tetrahedra stored
with the object give the same body in seconds, without a new tetrahedralization.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.bake.job import run_bake
from ...core.bake.steps import BakeSettings
from ...core.body import body_file
from ...core.body.body_file import BodyFileError
from ...core.body.body_key import is_key_of
from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.mesh.tet_mesh import TetMesh
from ...core.stiffness.pins import PinNodes
from ...core.stiffness.regions import TetScale
from ..scene.package_preferences import PACKAGE, preferences

FOLDER = "palpate"
KEY_LETTERS = 12
EMBEDDED = ("nodes", "tets", "fixed")
# Only where the stiffness varies.
EMBEDDED_SCALE = "young_scale"


@dataclass(frozen=True, eq=False)
class EmbeddedBody:
    """Body inside the .blend: the tetrahedra, the pinned nodes (p,), and the factor on Young's
    modulus of each tetrahedron (M,), None where all are 1.
    """

    mesh: TetMesh
    fixed: NDArray[np.int64]
    young_scale: NDArray[np.float64] | None

    @property
    def stiffness(self) -> TetScale | None:
        """Factors for a bake."""
        return None if self.young_scale is None else TetScale(self.young_scale)

    def has_key(self, key: str, poisson_ratio: float, formulation: str) -> bool:
        """Whether ``key`` is that of the body with a material, also an older one."""
        return is_key_of(key, self.mesh, self.fixed, poisson_ratio, formulation, self.young_scale)


# Damaged files and their modification times: the panel offers to rebuild them.
_damaged: dict[Path, int] = {}


def file_name(thing: bpy.types.Object, key: str) -> str:
    """``<object>-<start of the key>.npz``."""
    return f"{bpy.path.clean_name(thing.name)}-{key[:KEY_LETTERS]}.npz"


def folder_for_new_files() -> Path:
    """Folder next to the saved .blend; before saving that of the preferences, or the user's."""
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
    """Body file of the object, searched in all known folders."""
    name = thing.palpate.body_file
    if not name:
        return None
    return next((place / name for place in _places() if (place / name).is_file()), None)


def locate_key(key: str) -> Path | None:
    """Body file with this key, of any object."""
    found = (path for place in _places() for path in place.glob(f"*-{key[:KEY_LETTERS]}.npz"))
    return next((path for path in found if not is_known_damaged(path)), None)


def _places() -> list[Path]:
    beside = [Path(bpy.data.filepath).parent / FOLDER] if bpy.data.filepath else []
    return [*beside, _unsaved_folder()]


def load(thing: bpy.types.Object) -> SoftBody:
    """Read the object's body and check that it is this object's.

    Raises
    ------
    PalpateError
        Never baked.
    BodyFileError
        Missing, damaged, or another object's; Rebuild Body makes it again.
    """
    baked = thing.palpate
    if not baked.body_key:
        raise PalpateError("{name}: it is not soft yet; press Make Soft first", name=thing.name)
    path = locate(thing)
    if path is None:
        raise BodyFileError(
            "{name}: its body file '{file}' is missing; press Rebuild Body",
            name=thing.name,
            file=baked.body_file,
        )
    return load_file(path, baked.body_key)


def load_file(path: Path, key: str) -> SoftBody:
    """Read a body file and check its key; remembers damaged files.

    Raises
    ------
    BodyFileError
        As for :func:`load`.
    """
    try:
        return _with_key(body_file.load(path), key, path)
    except BodyFileError:
        _damaged[path] = path.stat().st_mtime_ns
        raise


def _with_key(body: SoftBody, key: str, path: Path) -> SoftBody:
    if body.key != key:
        raise BodyFileError(
            "{path}: it is the body of something else than its name says; press Rebuild Body",
            path=path,
        )
    return body


def is_known_damaged(path: Path) -> bool:
    """Whether :func:`load` found this file damaged, and it is unchanged since."""
    return path in _damaged and _damaged[path] == path.stat().st_mtime_ns


def restore(thing: bpy.types.Object) -> SoftBody:
    """Compute a missing body again from the tetrahedra in the .blend, and store its file.

    Blocks: a second or two for a thousand free surface nodes.

    Raises
    ------
    PalpateError
        There are no tetrahedra, or they are not those of the body that was baked.
    """
    baked = thing.palpate
    within = embedded(thing)
    ratio = round(baked.baked_poisson_ratio, 6)
    if not within.has_key(baked.body_key, ratio, baked.baked_formulation):
        raise PalpateError(
            "{name}: the tetrahedra in this file are not those of its body; press Make Soft",
            name=thing.name,
        )
    settings = BakeSettings(
        ratio,
        baked.young_modulus,
        PinNodes(within.fixed),
        formulation=baked.baked_formulation,
        form=baked.baked_form,
        tolerance=baked.baked_tolerance / 100,
        stiffness=within.stiffness,
    )
    target = folder_for_new_files() / baked.body_file
    python = (sys.executable, *bpy.app.python_args)
    body, _ = run_bake(within.mesh, settings, target, python=python)
    baked.body_key = body.key
    return body


def embed(thing: bpy.types.Object, body: SoftBody) -> None:
    """Store the tetrahedra on the object, in the .blend."""
    _remove_embedded(thing)
    thing.palpate["nodes"] = body.mesh.nodes.ravel()
    thing.palpate["tets"] = body.mesh.tets.astype(np.int32).ravel()
    thing.palpate["fixed"] = body.fixed.astype(np.int32)
    if body.young_scale is not None:
        thing.palpate[EMBEDDED_SCALE] = body.young_scale.astype(np.float64)


def _remove_embedded(thing: bpy.types.Object) -> None:
    # Also before writing: overwriting an array property corrupts memory (Blender 4.5 to 5.2).
    for name in (*EMBEDDED, EMBEDDED_SCALE):
        if name in thing.palpate:
            del thing.palpate[name]


def embedded(thing: bpy.types.Object) -> EmbeddedBody:
    """Tetrahedra, pins and stiffness stored with the object.

    Raises
    ------
    PalpateError
        There are none.
    """
    baked = thing.palpate
    if any(name not in baked for name in EMBEDDED):
        raise PalpateError(
            "{name}: there are no tetrahedra in this file to rebuild from; press Make Soft",
            name=thing.name,
        )
    nodes, tets, fixed = (np.array(baked[name]) for name in EMBEDDED)
    scale = np.array(baked[EMBEDDED_SCALE]) if EMBEDDED_SCALE in baked else None
    mesh = TetMesh.checked(nodes.reshape(-1, 3), tets.reshape(-1, 4))
    return EmbeddedBody(mesh, fixed.astype(np.int64), scale)


def forget(thing: bpy.types.Object) -> None:
    """Remove the body: its file, unless shared with another object, and the object's record."""
    name, path = thing.palpate.body_file, locate(thing)
    shared = any(o != thing and o.palpate.body_file == name for o in bpy.data.objects)
    if path is not None and not shared:
        path.unlink()
    _remove_embedded(thing)
    for setting in ("body_key", "body_file", "fingerprint", "baked_formulation", "baked_form"):
        thing.palpate.property_unset(setting)


def new_files() -> set[Path]:
    """Folder for new body files, and its contents."""
    folder = folder_for_new_files()
    return {folder, *folder.iterdir()} if folder.is_dir() else set()


def take_back(before: set[Path]) -> None:
    """Remove files that are new in the folder since :func:`new_files`."""
    for path in sorted(new_files() - before, reverse=True):
        if path.is_dir():
            path.rmdir()
        else:
            path.unlink()


def gather_beside(blend: Path, found: dict[str, Path], *, is_open_file: bool) -> None:
    """After a save, collect the body files at ``found`` (by name) in the folder next to ``blend``.

    Files in the user's folder, from before there was a .blend, are moved, others copied.

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
        body_file.adopt(source, target)
        if is_open_file and source.parent == _unsaved_folder():
            source.unlink()
