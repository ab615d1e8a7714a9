"""Tetrahedra, pins and stiffness of an object's body inside the .blend.

They come with a file that may be a stranger's: each is checked before it is used.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.bake.settings import BakeSettings
from ...core.body.body_key import body_key, is_key_of
from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.mesh.tet_mesh import TetMesh, young_scale_checked
from ...core.stiffness.held_pins import free_or_pinned
from ...core.stiffness.pins import held_at
from ...core.stiffness.regions import TetScale

ARRAYS = ("nodes", "tets", "fixed")
# Only where the stiffness varies.
SCALE = "young_scale"


@dataclass(frozen=True, eq=False)
class EmbeddedBody:
    """Body inside the .blend: the tetrahedra, the pinned nodes (p,), and the factor on Young's
    modulus of each tetrahedron (M,), None where all are 1.
    """

    mesh: TetMesh
    fixed: NDArray[np.int64]
    young_scale: NDArray[np.float64] | None

    def baked_with(self, settings: BakeSettings) -> BakeSettings:
        """Settings of a bake that holds the same nodes and has the same factors."""
        return replace(settings, pins=held_at(self.fixed), stiffness=self.stiffness)

    @property
    def stiffness(self) -> TetScale | None:
        """Factors for a bake."""
        return None if self.young_scale is None else TetScale(self.young_scale)

    def key(self, settings: BakeSettings) -> str:
        """Key of the body with a material."""
        ratio, formulation = settings.poisson_ratio, settings.formulation
        return body_key(self.mesh, self.fixed, ratio, formulation, self.young_scale)

    def has_key(self, key: str, settings: BakeSettings) -> bool:
        """Whether ``key`` is that of the body with a material, also as older files have it."""
        ratio, formulation = settings.poisson_ratio, settings.formulation
        return is_key_of(key, self.mesh, self.fixed, ratio, formulation, self.young_scale)


def embed(thing: bpy.types.Object, body: SoftBody) -> None:
    """Store the tetrahedra on the object, in the .blend."""
    remove(thing)
    thing.palpate["nodes"] = body.mesh.nodes.ravel()
    thing.palpate["tets"] = body.mesh.tets.astype(np.int32).ravel()
    thing.palpate["fixed"] = body.fixed.astype(np.int32)
    if body.young_scale is not None:
        thing.palpate[SCALE] = body.young_scale.astype(np.float64)


def remove(thing: bpy.types.Object) -> None:
    """Remove them from the object."""
    # Also before writing: overwriting an array property corrupts memory (Blender 4.5 to 5.2).
    for name in (*ARRAYS, SCALE):
        if name in thing.palpate:
            del thing.palpate[name]


def embedded(thing: bpy.types.Object) -> EmbeddedBody:
    """Tetrahedra, pins and stiffness stored with the object, checked.

    Raises
    ------
    PalpateError
        There are none, or they cannot be used.
    """
    baked = thing.palpate
    if any(name not in baked for name in ARRAYS):
        raise PalpateError(
            "{name}: there are no tetrahedra in this file to rebuild from; press Make Soft",
            name=thing.name,
        )
    try:
        nodes, tets = _numbers(baked, "nodes", "fd"), _numbers(baked, "tets", "i")
        mesh = TetMesh.checked(_rows(nodes, 3), _rows(tets, 4))
        fixed = free_or_pinned(mesh, _numbers(baked, "fixed", "i"))
        scale = None
        if SCALE in baked:
            scale = young_scale_checked(_numbers(baked, SCALE, "fd"), len(mesh.tets))
    except PalpateError as problem:
        raise PalpateError(
            "{name}: the tetrahedra in this file cannot be used ({problem}); press Make Soft",
            name=thing.name,
            problem=problem,
        ) from problem
    return EmbeddedBody(mesh, fixed, scale)


def _numbers(baked: bpy.types.PropertyGroup, name: str, kinds: str) -> NDArray[Any]:
    """The array of an ID property, (k,), of one of the ``kinds`` that Blender tells by letters."""
    stored = baked[name]
    # Nothing else that an ID property may hold has a type code: text, groups, objects, numbers.
    if getattr(stored, "typecode", "") not in set(kinds):
        raise PalpateError("'{array}' is no array of numbers of its kind", array=name)
    return np.array(stored).reshape(-1)


def _rows(numbers: NDArray[Any], width: int) -> NDArray[Any]:
    """An array (k,) as rows (k / width, width), (k,) where it does not divide."""
    return numbers if len(numbers) % width else numbers.reshape(-1, width)
