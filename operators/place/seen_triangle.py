"""Triangle of an evaluated mesh that has a touched place, and how it is turned.

It is searched for among all polygons, in one pass: Blender's own search makes a tree of each mesh
that it is asked about, and a pressed one is another after every step.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils.geometry import tessellate_polygon
from numpy.typing import NDArray

from ...core.body.drawn_polygons import Polygons
from ...core.mesh.closest_point import closest_area_coordinates
from ..scene import drawn_surface
from ..scene.body_frame import BodyFrame

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SeenTriangle:
    """Place in a triangle of a mesh, wound as its polygon is.

    Attributes
    ----------
    vertices : int64 (3,), of the triangle.
    corners : float64 (3, 3), where they are, local units.
    alpha : float64 (3,), area coordinates of the place.
    away : its distance from where it was looked for, local units; on a ray in lengths of its
        direction.
    """

    vertices: NDArray[np.int64]
    corners: Array
    alpha: Array
    away: float

    @property
    def place(self) -> Array:
        """The place (3,), local units."""
        return self.alpha @ self.corners


def first_on_ray(mesh: bpy.types.Mesh, origin: Array, direction: Array) -> SeenTriangle | None:
    """First place of a mesh on a ray (3,), from either side, local units; None beside it."""
    found = _polygons(mesh).on_line(origin, direction)
    places = (_on_ray(mesh, int(face), origin, direction) for face in found)
    ahead = [place for place in places if place is not None and place.away >= 0.0]
    return min(ahead, key=lambda place: place.away, default=None)


def nearest(mesh: bpy.types.Mesh, point: Array) -> SeenTriangle | None:
    """Place of a mesh nearest to a point (3,), local units; None of one without faces."""
    face = _polygons(mesh).nearest(point)
    if face is None:
        return None
    vertices, corners = _triangles(mesh, face)
    alpha = closest_area_coordinates(np.repeat(point[None], len(corners), axis=0), corners)
    away = np.linalg.norm(np.einsum("tc,tcx->tx", alpha, corners) - point, axis=1)
    best = int(np.argmin(away))
    return SeenTriangle(vertices[best], corners[best], alpha[best], float(away[best]))


def _polygons(mesh: bpy.types.Mesh) -> Polygons:
    places = drawn_surface.coordinates(mesh).reshape(-1, 3)
    return Polygons(places, *drawn_surface.polygons(mesh))


def _triangles(mesh: bpy.types.Mesh, face: int) -> tuple[NDArray[np.int64], Array]:
    """Vertices (t, 3) of the triangles of a polygon, wound as it is, and their places (t, 3, 3)."""
    polygon = mesh.polygons[face]
    vertices = np.array(polygon.vertices, dtype=np.int64)
    points = [mesh.vertices[vertex].co for vertex in polygon.vertices]
    split = np.array(tessellate_polygon([points]), dtype=np.int64)
    corners = np.array(points, dtype=np.float64)[split]
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    turned = outward @ np.array(polygon.normal) < 0.0
    split[turned], corners[turned] = split[turned, ::-1], corners[turned, ::-1]
    return vertices[split], corners


def _on_ray(
    mesh: bpy.types.Mesh, face: int, origin: Array, direction: Array
) -> SeenTriangle | None:
    """Where a ray goes through a polygon that is on its line; None for one seen edge on."""
    vertices, corners = _triangles(mesh, face)
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = outward @ direction
    seen = np.flatnonzero(facing)
    if not len(seen):
        return None
    vertices, corners = vertices[seen], corners[seen]
    outward, facing = outward[seen], facing[seen]
    away = np.einsum("tx,tx->t", corners[:, 0] - origin, outward) / facing
    places = origin + away[:, None] * direction
    # Of edges (j, k), (k, i), (i, j), in shares of the triangle as the ray sees it.
    alpha = np.stack(
        [
            np.cross(corners[:, j] - places, corners[:, k] - places) @ direction / facing
            for j, k in ((1, 2), (2, 0), (0, 1))
        ],
        axis=1,
    )
    best = int(np.argmax(alpha.min(axis=1)))
    # By rounding it may be a hair beside it.
    inside = np.clip(alpha[best], 0.0, None)
    return SeenTriangle(vertices[best], corners[best], inside / inside.sum(), float(away[best]))


def outward_normal(corners: Array, frame: BodyFrame) -> Array:
    """Outward unit normal (3,) of a triangle (3, 3) in the body; zero of one without area."""
    outward = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    outward *= -1.0 if frame.mirrored else 1.0
    length = float(np.linalg.norm(outward))
    return outward / length if length > 0.0 else outward


def turn_between(before: Array, after: Array) -> Array:
    """Rotation (3, 3) that best takes the edges and the normal of one triangle to another's."""
    one, two = _axes(before), _axes(after)
    if min(abs(np.linalg.det(one)), abs(np.linalg.det(two))) < 1e-12:
        return np.eye(3)
    left, _, right = np.linalg.svd(two @ np.linalg.inv(one))
    turn: Array = left @ np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))]) @ right
    return turn


def _axes(corners: Array) -> Array:
    """Edges and normal of a triangle (3, 3), as columns, in lengths of its longest edge."""
    one, two = corners[1] - corners[0], corners[2] - corners[0]
    normal = np.cross(one, two)
    longest = max(float(np.linalg.norm(one)), float(np.linalg.norm(two)), 1e-300)
    unit = normal / max(float(np.linalg.norm(normal)), 1e-300)
    return np.column_stack([one / longest, two / longest, unit])
