"""Triangle of an evaluated mesh that has a touched place, and how it is turned."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector
from mathutils.geometry import tessellate_polygon
from numpy.typing import NDArray

from ...core.mesh.closest_point import closest_area_coordinates
from ..scene.body_frame import BodyFrame

Array = NDArray[np.float64]


def triangle_at(mesh: bpy.types.Mesh, face: int, place: Vector) -> tuple[list[int], Array]:
    """Vertices of the triangle of a polygon that has a place, and its area coordinates there."""
    vertices = list(mesh.polygons[face].vertices)
    points = [mesh.vertices[vertex].co for vertex in vertices]
    triangles = np.array(tessellate_polygon([points]))
    corners = np.array(points, dtype=np.float64)[triangles]
    asked = np.repeat(np.array([place], dtype=np.float64), len(triangles), axis=0)
    alphas = closest_area_coordinates(asked, corners)
    missed = np.linalg.norm(np.einsum("tc,tcx->tx", alphas, corners) - asked, axis=1)
    best = int(np.argmin(missed))
    chosen = [vertices[corner] for corner in triangles[best]]
    # Wound as the polygon is.
    i, j, k = (Vector(corner) for corner in corners[best])
    if (j - i).cross(k - i).dot(mesh.polygons[face].normal) < 0.0:
        return chosen[::-1], alphas[best][::-1]
    return chosen, alphas[best]


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
