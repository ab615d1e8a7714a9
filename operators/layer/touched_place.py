"""Place on an object as it is seen, after its pose, keys, layers and other modifiers; and at rest.

A displacement at rest is seen turned by what comes after the layers. So the body is pressed at
rest, in a local frame: where the touched place is seen, turned as its surroundings are.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import rest_coordinates
from ..scene.seen_triangle import outward_normal, triangle_at, turn_between
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
    corners, alpha = triangle_at(mesh, face, place)
    local = np.array([mesh.vertices[corner].co for corner in corners], dtype=np.float64)
    seen = frame.body_from_local(local)
    rest, before = _marked(mesh, REST, corners), _marked(mesh, AT, corners)
    if rest is None or before is None:
        rest, turn = _rest_by_number(thing, mesh, corners), np.eye(3)
    else:
        turn = turn_between(frame.body_from_local(before), seen)
    return TouchedPlace(
        rest=alpha @ frame.body_from_local(rest),
        seen=alpha @ seen,
        normal=outward_normal(seen, frame),
        turn=turn,
    )


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
