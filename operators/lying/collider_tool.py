"""Tools from a collider, a mesh object that bodies rest on: a convex one is one, a flat one a slab,
a hollow one its convex parts.

The object is not modified.
"""

from __future__ import annotations

import sys

import bpy
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from ...core.contact.tool.convex_parts import convex_parts
from ...core.contact.tool.convex_tool import convex
from ...core.contact.tool.tools import Tool, span
from ...core.errors import PalpateError
from ..place.evaluation import evaluated
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import coordinates, frame_of
from ..tool.hull import FLAT, hull_of

Array = NDArray[np.float64]

# How thick a flat collider is taken to be, behind its face, as a share of its smaller side.
THICKNESS = 0.5
# Share of its outline by which a flat one may fall short of being convex.
HOLLOW = 0.01


def collider_tools(thing: bpy.types.Object, graph: bpy.types.Depsgraph) -> list[Tool]:
    """Shapes of a collider with its modifiers and scale as a graph has it, metres in its own axes.

    Raises
    ------
    PalpateError
        It is no mesh, has no faces, or is hollow and cannot be taken apart, with the remedy.
    """
    if thing.type != "MESH":
        raise PalpateError(
            "colliders: {name} is not a mesh; take it out of the collection", name=thing.name
        )
    seen = evaluated(thing, graph)
    frame = frame_of(seen, graph.scene)
    places, triangles = _faces(thing.name, seen, frame)
    slab = _slab(thing.name, places, triangles)
    if slab is not None:
        return [convex(slab, name=thing.name)]
    hull = hull_of(thing, graph.scene, graph)
    if not hull.hollow:
        return [convex(hull.corners, name=thing.name)]
    python = (sys.executable, *bpy.app.python_args)
    return convex_parts(places, triangles, thing.name, python)


def _faces(name: str, seen: bpy.types.Object, frame: BodyFrame) -> tuple[Array, NDArray[np.int64]]:
    """Vertices (n, 3), metres, and triangles (f, 3) of a mesh as seen, wound outwards."""
    mesh = seen.to_mesh()
    try:
        places = frame.body_from_local(coordinates(mesh).reshape(-1, 3))
        mesh.calc_loop_triangles()
        corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners)
    finally:
        seen.to_mesh_clear()
    triangles = frame.wind(corners.reshape(-1, 3).astype(np.int64))
    if len(places) < 3 or not len(triangles) or not _area_vectors(places, triangles).any():
        raise PalpateError(
            "colliders: {name} has no face to rest on; take it out of the collection", name=name
        )
    return places, triangles


def _area_vectors(places: Array, triangles: NDArray[np.int64]) -> Array:
    """Normals (f, 3) of triangles, as long as their areas."""
    a, b, c = (places[triangles[:, corner]] for corner in range(3))
    vectors: Array = 0.5 * np.cross(b - a, c - a)
    return vectors


def _slab(name: str, places: Array, triangles: NDArray[np.int64]) -> Array | None:
    """Corners (k, 3) of a flat mesh and of what is behind it; None for one with volume."""
    axes = span(places)[1]
    lengths = np.ptp(places @ axes, axis=0)
    if lengths[2] > FLAT * lengths[0]:
        return None
    outline = ConvexHull(places @ axes[:, :2])
    vectors = _area_vectors(places, triangles)
    # Of a polygon Qhull's volume is the area.
    if np.linalg.norm(vectors, axis=1).sum() < (1.0 - HOLLOW) * outline.volume:
        raise PalpateError(
            "colliders: {name} is flat and not convex; give it thickness (Solidify), or put convex "
            "parts of it into the collection",
            name=name,
        )
    corners, up = places[outline.vertices], vectors.sum(axis=0)
    behind = corners - THICKNESS * lengths[1] * up / np.linalg.norm(up)
    return np.concatenate([corners, behind])
