"""Place on an object as it is seen, after its pose, keys, layers and other modifiers; and at rest.

A displacement at rest is seen turned by what comes after the layers. So the body is pressed at
rest, in a local frame: where the touched place is seen, turned as its surroundings are.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector
from mathutils.geometry import tessellate_polygon
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.mesh.closest_point import closest_area_coordinates
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import rest_coordinates
from . import place_marks
from .layer_groups import AT, REST

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TouchedPlace:
    """Place on the mesh as evaluated, metres, in body coordinates of the object's frame.

    Attributes
    ----------
    rest, seen : float64 (3,), where it is at rest, and as seen.
    normal : float64 (3,), outward unit normal as seen.
    turn : float64 (3, 3), rotation from a displacement at rest to the same as seen.
    """

    rest: Array
    seen: Array
    normal: Array
    turn: Array

    def frame(self, of_object: BodyFrame) -> BodyFrame:
        """Local frame, by the present one of the object."""
        return of_object.posed(self.turn, self.rest, self.seen)


def is_seen_at_rest(thing: bpy.types.Object) -> bool:
    """Whether nothing moves an object's vertices from their places at rest."""
    keys = thing.data.shape_keys
    moved = any(modifier.show_viewport for modifier in thing.modifiers)
    return not moved and (keys is None or len(keys.key_blocks) < 2)


def under_ray(
    thing: bpy.types.Object, frame: BodyFrame, origin: Array, direction: Array
) -> TouchedPlace | None:
    """First place of an object on a ray (3,), world coordinates; None beside it."""
    matrix = thing.matrix_world.inverted()
    seen, start = _evaluated(thing), matrix @ Vector(origin)
    along = (matrix.to_3x3() @ Vector(direction)).normalized()
    if not len(seen.data.polygons):
        return None
    hit, place, _, face = seen.ray_cast(start, along)
    return _on_face(thing, frame, face, place) if hit else None


def nearest(thing: bpy.types.Object, frame: BodyFrame, at: Array) -> TouchedPlace:
    """Place of an object nearest to a point (3,), world coordinates.

    Raises
    ------
    PalpateError
        It shows no face.
    """
    point, seen = thing.matrix_world.inverted() @ Vector(at), _evaluated(thing)
    if not len(seen.data.polygons):
        raise PalpateError("{name} shows no face to touch; look at its modifiers", name=thing.name)
    _, place, _, face = seen.closest_point_on_mesh(point)
    return _on_face(thing, frame, face, place)


def _evaluated(thing: bpy.types.Object) -> bpy.types.Object:
    return thing.evaluated_get(bpy.context.evaluated_depsgraph_get())


def _on_face(thing: bpy.types.Object, frame: BodyFrame, face: int, place: Vector) -> TouchedPlace:
    mesh = _evaluated(thing).data
    corners, alpha = _triangle(mesh, face, place)
    local = np.array([mesh.vertices[corner].co for corner in corners], dtype=np.float64)
    seen = frame.body_from_local(local)
    rest, before = _marked(mesh, REST, corners), _marked(mesh, AT, corners)
    if rest is None or before is None:
        rest, turn = _rest_by_number(thing, mesh, corners), np.eye(3)
    else:
        turn = _turn(frame.body_from_local(before), seen)
    outward = np.cross(seen[1] - seen[0], seen[2] - seen[0]) * (-1.0 if frame.mirrored else 1.0)
    length = float(np.linalg.norm(outward))
    return TouchedPlace(
        rest=alpha @ frame.body_from_local(rest),
        seen=alpha @ seen,
        normal=outward / length if length > 0.0 else outward,
        turn=turn,
    )


def _triangle(mesh: bpy.types.Mesh, face: int, place: Vector) -> tuple[list[int], Array]:
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


def _marked(mesh: bpy.types.Mesh, name: str, corners: list[int]) -> Array | None:
    """Marks (3, 3) of vertices; None without."""
    attribute = mesh.attributes.get(name)
    if attribute is None or (attribute.data_type, attribute.domain) != ("FLOAT_VECTOR", "POINT"):
        return None
    return np.array([attribute.data[corner].vector for corner in corners], dtype=np.float64)


def _rest_by_number(thing: bpy.types.Object, mesh: bpy.types.Mesh, corners: list[int]) -> Array:
    """Local coordinates (3, 3) at rest of vertices that are the object's own."""
    rest = rest_coordinates(thing.data).reshape(-1, 3)
    if len(rest) != len(mesh.vertices) or place_marks.needed(thing):
        raise PalpateError(
            "{name}: its modifiers make vertices that cannot be followed; press again",
            name=thing.name,
        )
    return rest[corners].astype(np.float64)


def _turn(before: Array, after: Array) -> Array:
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
