"""Tool from a collider, a mesh object that bodies rest on: its convex hull, of a flat one a slab.

The object is not modified.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

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


def collider_tool(thing: bpy.types.Object, graph: bpy.types.Depsgraph) -> Tool:
    """Shape of a collider with its modifiers and scale as a graph has it, metres in its own axes.

    Raises
    ------
    PalpateError
        It is no mesh, has no faces, or is hollow, with the remedy.
    """
    if thing.type != "MESH":
        raise PalpateError(
            "colliders: {name} is not a mesh; take it out of the collection", name=thing.name
        )
    seen = evaluated(thing, graph)
    slab = _slab(thing.name, seen, frame_of(seen, graph.scene))
    if slab is not None:
        return convex(slab, name=thing.name)
    hull = hull_of(thing, graph.scene, graph)
    if hull.hollow:
        raise _hollow(thing.name)
    return convex(hull.corners, name=thing.name)


def _slab(name: str, seen: bpy.types.Object, frame: BodyFrame) -> Array | None:
    """Corners (k, 3) of a flat mesh and of what is behind it; None for one with volume."""
    mesh = seen.to_mesh()
    try:
        places = frame.body_from_local(coordinates(mesh).reshape(-1, 3))
        normals, areas = _faces(mesh, frame, places)
    finally:
        seen.to_mesh_clear()
    if len(places) < 3 or not areas.sum() > 0.0:
        raise PalpateError(
            "colliders: {name} has no face to rest on; take it out of the collection", name=name
        )
    axes = span(places)[1]
    lengths = np.ptp(places @ axes, axis=0)
    if lengths[2] > FLAT * lengths[0]:
        return None
    outline = ConvexHull(places @ axes[:, :2])
    # Of a polygon Qhull's volume is the area.
    if areas.sum() < (1.0 - HOLLOW) * outline.volume:
        raise _hollow(name)
    corners, up = places[outline.vertices], areas @ normals
    behind = corners - THICKNESS * lengths[1] * up / np.linalg.norm(up)
    return np.concatenate([corners, behind])


def _faces(mesh: bpy.types.Mesh, frame: BodyFrame, places: Array) -> tuple[Array, Array]:
    """Unit normals (f, 3) and areas (f,) of a mesh's triangles, vertices at ``places``, metres."""
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    triangles = frame.wind(corners.reshape(-1, 3).astype(np.int64))
    a, b, c = (places[triangles[:, corner]] for corner in range(3))
    across = np.cross(b - a, c - a)
    twice = np.linalg.norm(across, axis=1)
    return across / np.maximum(twice, np.finfo(float).tiny)[:, None], 0.5 * twice


def _hollow(name: str) -> PalpateError:
    return PalpateError(
        "colliders: {name} is hollow, and only convex shapes bear bodies; put convex parts of it "
        "into the collection instead, such as the boards of a box",
        name=name,
    )
