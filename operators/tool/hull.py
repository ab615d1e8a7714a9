"""Convex tool from a mesh object: Blender's convex hull, with few corners.

The object is not modified.
"""

from __future__ import annotations

from dataclasses import dataclass

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ..scene.drawn_surface import coordinates, frame_of, polygons

Array = NDArray[np.float64]

# Corners at most, for the tick's distance to a hull.
MOST_CORNERS = 64
# Relative excess volume of a hull over its mesh that indicates a hollow.
HOLLOW = 0.01
# Share of its size below which a hull is flat.
FLAT = 1e-3

# Hulls made last, by their object, with the mesh that each is of: as long as that stays the same it
# is not made again in every frame.
_made: dict[int, tuple[tuple[NDArray[np.generic], ...], _LocalHull]] = {}
MOST_KEPT = 64


@dataclass(frozen=True, eq=False)
class Hull:
    """Corners (k, 3) of a hull, metres in the object's axes; a remark on changes to the mesh, empty
    where it was convex and simple; whether the mesh was smaller than its hull.
    """

    corners: Array
    remark: str
    hollow: bool


@dataclass(frozen=True, eq=False)
class _LocalHull:
    """Corners (k, 3), local units, and whether the mesh was smaller than its hull."""

    corners: Array
    hollow: bool


def hull_of(
    thing: bpy.types.Object, scene: bpy.types.Scene, graph: bpy.types.Depsgraph | None = None
) -> Hull:
    """Convex hull of an object with modifiers and scale, as a graph has it; without one as the view
    does.

    Raises
    ------
    PalpateError
        An object that is not a mesh, has no volume, or is flattened by its transform.
    """
    if thing.type != "MESH":
        raise PalpateError(
            "tool: {name} is not a mesh; choose a mesh object as the tool", name=thing.name
        )
    evaluated = thing.evaluated_get(graph or bpy.context.evaluated_depsgraph_get())
    try:
        frame = frame_of(evaluated, scene)
    except PalpateError as problem:
        raise PalpateError("tool {name}: {problem}", name=thing.name, problem=problem) from problem
    local = _local_hull(thing, evaluated)
    corners = frame.body_from_local(local.corners)
    if len(corners) < 4 or _thickness(corners) <= FLAT * float(np.ptp(corners, axis=0).max()):
        raise PalpateError(
            "tool: {name} has no volume; give it at least four vertices that are not in a plane, "
            "or choose Plate",
            name=thing.name,
        )
    few = _most_spread(corners)
    remark = _remark(thing.name, len(corners), len(few), hollow=local.hollow)
    return Hull(few, remark, local.hollow)


def _remark(name: str, corners: int, left: int, *, hollow: bool) -> str:
    """Remark on changes to a mesh; empty if there were none."""
    convex = Sentence("it is not convex, so its convex hull presses")
    fewer = Sentence(
        "its hull was simplified from {corners} to {left} corners", corners=corners, left=left
    )
    if hollow and left < corners:
        return Sentence("{name}: {first}; {second}", name=name, first=convex, second=fewer)
    if hollow or left < corners:
        return Sentence("{name}: {problem}", name=name, problem=convex if hollow else fewer)
    return ""


def _local_hull(thing: bpy.types.Object, evaluated: bpy.types.Object) -> _LocalHull:
    """Hull of what an object is evaluated to: the one made last, if that was the same."""
    mesh = evaluated.to_mesh()
    try:
        arrays = (coordinates(mesh), *polygons(mesh))
        known = _made.pop(thing.session_uid, None)
        if known is None or not all(map(np.array_equal, known[0], arrays)):
            known = arrays, _blenders_hull(mesh)
    finally:
        evaluated.to_mesh_clear()
    # The one asked for last is the last that is forgotten.
    _made[thing.session_uid] = known
    while len(_made) > MOST_KEPT:
        del _made[next(iter(_made))]
    return known[1]


def forget() -> None:
    """Free the memory of the hulls made last."""
    _made.clear()


def _blenders_hull(mesh: bpy.types.Mesh) -> _LocalHull:
    shape = bmesh.new()
    try:
        shape.from_mesh(mesh)
        before = abs(shape.calc_volume())
        if len(shape.verts) < 4:
            return _LocalHull(np.zeros((0, 3)), hollow=False)
        made = bmesh.ops.convex_hull(shape, input=shape.verts, use_existing_faces=False)
        inside = {
            vertex for vertex in made["geom_interior"] if isinstance(vertex, bmesh.types.BMVert)
        }
        on_hull = {
            vertex
            for face in made["geom"]
            if isinstance(face, bmesh.types.BMFace)
            for vertex in face.verts
        }
        corners = np.array([vertex.co for vertex in on_hull - inside], dtype=np.float64)
    finally:
        shape.free()
    corners = corners.reshape(-1, 3)
    return _LocalHull(corners, hollow=_volume(corners) > (1.0 + HOLLOW) * before)


def _volume(corners: Array) -> float:
    """Volume of the convex hull of some points, by Blender; 0 for less than four."""
    shape = bmesh.new()
    try:
        for corner in corners.tolist():
            shape.verts.new(corner)
        if len(corners) < 4:
            return 0.0
        bmesh.ops.convex_hull(shape, input=shape.verts)
        bmesh.ops.recalc_face_normals(shape, faces=shape.faces)
        return abs(float(shape.calc_volume()))
    finally:
        shape.free()


def _thickness(points: Array) -> float:
    """Smallest extent of the points along their principal axes."""
    axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2]
    return float(np.ptp(points @ axes.T, axis=0).min())


def _most_spread(corners: Array) -> Array:
    """All corners if they are few; else a farthest-point sample."""
    if len(corners) <= MOST_CORNERS:
        return corners
    taken = [int(np.argmax(np.linalg.norm(corners - corners.mean(axis=0), axis=1)))]
    gap = np.linalg.norm(corners - corners[taken[0]], axis=1)
    while len(taken) < MOST_CORNERS:
        taken.append(int(np.argmax(gap)))
        gap = np.minimum(gap, np.linalg.norm(corners - corners[taken[-1]], axis=1))
    return corners[np.sort(taken)]
