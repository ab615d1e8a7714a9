"""Place on a soft object as it is seen: after its pose, keys, layers and other modifiers."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..layer.layer_groups import REST
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import metres_per_unit
from ..scene.seen_triangle import outward_normal, triangle_at, turn_between

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TouchedPlace:
    """Place on the mesh as evaluated.

    Attributes
    ----------
    thing : the object.
    frame : of the object, or of its instance that was hit.
    seen, normal : float64 (3,), place and outward unit normal, world coordinates.
    rest : float64 (3,), where it is at rest, metres, body coordinates.
    turn : float64 (3, 3), rotation from rest to as seen, body axes.
    """

    thing: bpy.types.Object
    frame: BodyFrame
    seen: Array
    normal: Array
    rest: Array
    turn: Array


def under_ray(
    scene: bpy.types.Scene, graph: bpy.types.Depsgraph, origin: Vector, direction: Vector
) -> TouchedPlace | None:
    """Place on the first object that a ray meets, world coordinates, if that is a soft one.

    Raises
    ------
    PalpateError
        Its transform flattens it.
    """
    met, _, _, _, thing, matrix = scene.ray_cast(graph, origin, direction)
    if not met or thing is None or thing.type != "MESH":
        return None
    thing = thing.original
    if not thing.palpate.body_key:
        return None
    back = matrix.inverted()
    start = back @ origin
    along = (back.to_3x3() @ direction).normalized()
    hit, place, _, face = thing.evaluated_get(graph).ray_cast(start, along)
    return _on_face(scene, graph, thing, matrix, face, place) if hit else None


def nearest(
    scene: bpy.types.Scene, graph: bpy.types.Depsgraph, thing: bpy.types.Object, at: Vector
) -> TouchedPlace:
    """Place of the evaluated mesh nearest to ``at``, world coordinates.

    Raises
    ------
    PalpateError
        There is none; its transform flattens it.
    """
    matrix = thing.matrix_world
    hit, place, _, face = thing.evaluated_get(graph).closest_point_on_mesh(matrix.inverted() @ at)
    if not hit:
        raise PalpateError("{name} shows no face to touch; show its faces", name=thing.name)
    return _on_face(scene, graph, thing, matrix, face, place)


def _on_face(
    scene: bpy.types.Scene,
    graph: bpy.types.Depsgraph,
    thing: bpy.types.Object,
    matrix: Matrix,
    face: int,
    place: Vector,
) -> TouchedPlace:
    frame = BodyFrame.of_matrix(np.array(matrix), metres_per_unit(scene))
    mesh = thing.evaluated_get(graph).data
    corners, alpha = triangle_at(mesh, face, place)
    seen = frame.body_from_local(np.array([mesh.vertices[corner].co for corner in corners]))
    at_rest = _rest(thing, mesh, corners)
    rest = seen if at_rest is None else frame.body_from_local(at_rest)
    return TouchedPlace(
        thing,
        frame,
        frame.world_from_body(alpha @ seen),
        frame.turn_to_world(outward_normal(seen, frame)),
        alpha @ rest,
        turn_between(rest, seen),
    )


def _rest(
    thing: bpy.types.Object, mesh: bpy.types.Mesh, corners: list[int]
) -> NDArray[np.float64] | None:
    """Local coordinates (3, 3) of vertices at rest; None where they cannot be told."""
    attribute = mesh.attributes.get(REST)
    if attribute is not None and attribute.data_type == "FLOAT_VECTOR":
        return np.array([attribute.data[corner].vector for corner in corners], dtype=np.float64)
    base = thing.data
    if len(mesh.vertices) != len(base.vertices):
        return None
    points = base.shape_keys.reference_key.points if base.shape_keys else base.vertices
    return np.array([points[corner].co for corner in corners], dtype=np.float64)
