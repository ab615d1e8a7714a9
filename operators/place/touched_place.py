"""Place on an object as it is seen, after its pose, keys, layers and other modifiers; and at rest.

A displacement at rest is seen turned by what comes after the layers. So the body is pressed at
rest, in a local frame: where the touched place is seen, turned as its surroundings are.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..layer import place_marks
from ..layer.imprints import imprinted_rest
from ..layer.layer_groups import AT, PRESSED, REST
from ..scene.body_frame import BodyFrame
from . import seen_triangle
from .evaluation import evaluated
from .seen_place import SeenPlace
from .seen_triangle import SeenTriangle, outward_normal, turn_between

Array = NDArray[np.float64]

# Relative difference of places that are the same: evaluated ones are float32.
SAME = 1e-6


@dataclass(frozen=True, eq=False)
class TouchedPlace:
    """Place on the mesh as evaluated, without what the live layer moves it by.

    Attributes
    ----------
    rest, seen : float64 (3,), where it is at rest, with its imprints, and as seen; metres, body
        coordinates of the object's frame, or of its instance's.
    normal : float64 (3,), outward unit normal as seen.
    turn : float64 (3, 3), rotation from a displacement at rest to the same as seen.
    corners : vertices of its triangle in the evaluated mesh.
    alpha : float64 (3,), area coordinates in it.
    """

    rest: Array
    seen: Array
    normal: Array
    turn: Array
    corners: tuple[int, ...] = ()
    alpha: Array | None = None

    def frame(self, of_object: BodyFrame) -> BodyFrame:
        """Local frame, by the present one of the object."""
        return of_object.posed(self.turn, self.rest, self.seen)

    def followed(self, thing: bpy.types.Object, frame: BodyFrame) -> TouchedPlace:
        """The same place as it is seen now, after another pose; as it was where that is unknown."""
        mesh = _evaluated(thing).data
        if self.alpha is None or max(self.corners, default=0) >= len(mesh.vertices):
            return self
        if not _is_marked(mesh):
            return self
        now = _on_triangle(thing, frame, mesh, list(self.corners), self.alpha)
        # Rounding is no motion.
        return self if now.is_at(self) else now

    def is_at(self, other: TouchedPlace) -> bool:
        """Whether it is seen where another is, and as that is turned."""
        size = float(np.linalg.norm(self.seen)) + float(np.linalg.norm(self.rest))
        return bool(
            np.abs(self.seen - other.seen).max() <= SAME * size
            and np.abs(self.turn - other.turn).max() <= SAME
        )


def is_seen_at_rest(thing: bpy.types.Object) -> bool:
    """Whether nothing moves an object's vertices from their places at rest."""
    keys = thing.data.shape_keys
    moved = any(modifier.show_viewport for modifier in thing.modifiers)
    return not moved and (keys is None or len(keys.key_blocks) < 2)


def touched(seen: SeenPlace, origin: Array, direction: Array) -> TouchedPlace:
    """What was seen on a ray (3,), world coordinates, and where it is at rest.

    Raises
    ------
    PalpateError
        It is not of the object's mesh.
    """
    place = under_ray(seen.thing, seen.frame, origin, direction)
    if place is None:
        raise PalpateError(
            "{name}: what is here is an instance that its modifiers make; Realize Instances makes "
            "it a part of the mesh",
            name=seen.thing.name,
        )
    return place


def under_ray(
    thing: bpy.types.Object, frame: BodyFrame, origin: Array, direction: Array
) -> TouchedPlace | None:
    """First place of an object on a ray (3,), world coordinates; None
    beside it.
    """
    start = _local(frame, origin)
    along = _local(frame, np.add(origin, direction)) - start
    mesh = _evaluated(thing).data
    return _of(thing, frame, mesh, seen_triangle.first_on_ray(mesh, start, along))


def nearest(
    thing: bpy.types.Object,
    frame: BodyFrame,
    at: Array,
    graph: bpy.types.Depsgraph | None = None,
) -> TouchedPlace:
    """Place of an object nearest to a point (3,), world coordinates, as a graph has it; without one
    as the view does.

    Raises
    ------
    PalpateError
        It shows no face, or is not shown at all.
    """
    mesh = evaluated(thing, graph or bpy.context.evaluated_depsgraph_get()).data
    place = _of(thing, frame, mesh, seen_triangle.nearest(mesh, _local(frame, at)))
    if place is None:
        raise PalpateError("{name} shows no face to touch; look at its modifiers", name=thing.name)
    return place


def _evaluated(thing: bpy.types.Object) -> bpy.types.Object:
    """The object as evaluated for the view.

    Where something changed since, Blender evaluates it again: what it had then may be gone.
    """
    return thing.evaluated_get(bpy.context.evaluated_depsgraph_get())


def _local(frame: BodyFrame, at: Array) -> Array:
    return frame.local_from_body(frame.body_from_world(np.asarray(at, dtype=np.float64)))


def _of(
    thing: bpy.types.Object,
    frame: BodyFrame,
    mesh: bpy.types.Mesh,
    found: SeenTriangle | None,
) -> TouchedPlace | None:
    """The place that was found on the evaluated mesh, if any."""
    if found is None:
        return None
    return _on_triangle(thing, frame, mesh, found.vertices.tolist(), found.alpha)


def _on_triangle(
    thing: bpy.types.Object,
    frame: BodyFrame,
    mesh: bpy.types.Mesh,
    corners: list[int],
    alpha: Array,
) -> TouchedPlace:
    seen = frame.body_from_local([mesh.vertices[corner].co for corner in corners])
    if not _is_marked(mesh):
        rest = frame.body_from_local(_rest_by_number(thing, mesh, corners))
        turn, moved = np.eye(3), np.zeros((3, 3))
    else:
        rest, before, moved = (
            frame.body_from_local(_marks(mesh, name, corners)) for name in (REST, AT, PRESSED)
        )
        turn = turn_between(before + moved, seen)
    return TouchedPlace(
        rest=alpha @ rest,
        seen=alpha @ seen - turn @ (alpha @ moved),
        normal=outward_normal(seen, frame),
        turn=turn,
        corners=tuple(corners),
        alpha=alpha,
    )


def _is_marked(mesh: bpy.types.Mesh) -> bool:
    found = (mesh.attributes.get(name) for name in (REST, AT, PRESSED))
    kind = ("FLOAT_VECTOR", "POINT")
    return all(one is not None and (one.data_type, one.domain) == kind for one in found)


def _marks(mesh: bpy.types.Mesh, name: str, corners: list[int]) -> Array:
    """Marks (3, 3) of vertices."""
    attribute = mesh.attributes[name]
    return np.array([attribute.data[corner].vector for corner in corners], dtype=np.float64)


def _rest_by_number(thing: bpy.types.Object, mesh: bpy.types.Mesh, corners: list[int]) -> Array:
    """Local coordinates (3, 3) at rest of vertices that are the drawn mesh's own."""
    rest = imprinted_rest(thing).reshape(-1, 3)
    if len(rest) != len(mesh.vertices) or place_marks.needed(thing):
        raise PalpateError(
            "{name}: its modifiers make vertices that cannot be followed; press again",
            name=thing.name,
        )
    return rest[corners].astype(np.float64)
