"""Rotation of a tool chosen in the scene, in the body's axes."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.pose import facing
from ...core.errors import PalpateError
from ..scene.body_frame import BodyFrame

Array = NDArray[np.float64]
Point = tuple[float, float, float]
# Rows of a rotation matrix.
Turn = tuple[Point, Point, Point]

WORLD_X = np.array([1.0, 0.0, 0.0])


def rotation(
    scene: bpy.types.Scene,
    body: BodyFrame,
    normal: Array,
    view_axes: Array | None = None,
) -> Array:
    """Tool to body (3, 3), for a tool set down where the outward normal (3,) is ``normal``, body
    axes. ``view_axes`` (3, 3) are the view's right, up and toward the viewer, world axes; without
    a view the tool lies on the surface.

    Raises
    ------
    PalpateError
        The object that turns it is flattened to nothing.
    """
    chosen = scene.palpate
    guide = guide_of(scene)
    if chosen.tip_turn == "OBJECT" and guide is not None:
        return as_object(guide, body)
    right = WORLD_X if view_axes is None else view_axes[0]
    if chosen.tip_turn == "VIEW" and view_axes is not None:
        return facing(body.turn_to_body(view_axes[2]), body.turn_to_body(right))
    return facing(normal, body.turn_to_body(right))


def guide_of(scene: bpy.types.Scene) -> bpy.types.Object | None:
    """The object as which the tool is turned: the chosen one, else the mesh that presses."""
    chosen = scene.palpate
    return chosen.turn_object or (chosen.tip_object if chosen.tip == "MESH" else None)


def as_object(thing: bpy.types.Object, body: BodyFrame) -> Array:
    """Tool to body (3, 3) of a tool that is turned as an object.

    Raises
    ------
    PalpateError
        It is flattened to nothing.
    """
    rotation: Array = body.rotation.T @ axes_of(thing)
    return rotation


def axes_of(thing: bpy.types.Object) -> Array:
    """Rotation of an object (3, 3): its axes in the world.

    Raises
    ------
    PalpateError
        It is flattened to nothing.
    """
    try:
        return BodyFrame.of_matrix(np.array(thing.matrix_world)).rotation
    except PalpateError as problem:
        raise PalpateError("{name}: {problem}", name=thing.name, problem=problem) from problem


def as_rows(rotation: Array) -> Turn:
    """A rotation (3, 3) as it can be compared."""
    (a, b, c), (d, e, f), (g, h, i) = rotation.tolist()
    return ((a, b, c), (d, e, f), (g, h, i))
