"""Place on a soft object as it is seen: after its pose, keys, layers and other modifiers."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector
from mathutils.geometry import tessellate_polygon
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.mesh.closest_point import closest_area_coordinates
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import metres_per_unit

Array = NDArray[np.float64]

# Point attribute of the evaluated mesh: the places at rest, also of vertices that modifiers made.
REST = "palpate_rest"


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
    corners, alpha = _triangle(mesh, face, place)
    seen = frame.body_from_local(np.array([mesh.vertices[corner].co for corner in corners]))
    at_rest = _rest(thing, mesh, corners)
    rest = seen if at_rest is None else frame.body_from_local(at_rest)
    outward = np.cross(seen[1] - seen[0], seen[2] - seen[0]) * (-1.0 if frame.mirrored else 1.0)
    outward /= np.linalg.norm(outward)
    return TouchedPlace(
        thing,
        frame,
        frame.world_from_body(alpha @ seen),
        frame.turn_to_world(outward),
        alpha @ rest,
        _turn(rest, seen),
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
    normal = mesh.polygons[face].normal
    i, j, k = (Vector(corner) for corner in corners[best])
    if (j - i).cross(k - i).dot(normal) < 0.0:
        return chosen[::-1], alphas[best][::-1]
    return chosen, alphas[best]


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


def _turn(rest: Array, seen: Array) -> Array:
    """Rotation (3, 3) that best takes a triangle's edges and normal at rest to those seen."""
    before, after = _axes(rest), _axes(seen)
    if min(abs(np.linalg.det(before)), abs(np.linalg.det(after))) < 1e-12:
        return np.eye(3)
    left, _, right = np.linalg.svd(after @ np.linalg.inv(before))
    turn: Array = left @ np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))]) @ right
    return turn


def _axes(corners: Array) -> Array:
    """Edges and normal of a triangle (3, 3), as columns, in lengths of its longest edge."""
    one, two = corners[1] - corners[0], corners[2] - corners[0]
    normal = np.cross(one, two)
    longest = max(np.linalg.norm(one), np.linalg.norm(two), 1e-300)
    unit = normal / max(np.linalg.norm(normal), 1e-300)
    return np.column_stack([one / longest, two / longest, unit])
