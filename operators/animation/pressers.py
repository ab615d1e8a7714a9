"""Pressers: the objects that press through an animation, each a tool with a pose.

They are those of the collection that the soft object names, or else what leads the scene's fingers.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool import tools
from ...core.contact.tool.convex_tool import convex
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.errors import PalpateError
from ..object.drawn_body import DrawnBody
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import metres_per_unit
from ..tool import hull, tool_turn
from ..tool.finger_tip import chosen_tip


@dataclass(frozen=True, eq=False)
class Presser:
    """Tool that moves with an object, and turns with ``turner``."""

    tool: Tool
    guide: bpy.types.Object
    turner: bpy.types.Object

    @property
    def place(self) -> NDArray[np.float64]:
        """Where it is, (3,), world coordinates."""
        return np.array(self.guide.matrix_world)[:3, 3]

    def pose(self, scene: bpy.types.Scene, body: BodyFrame) -> Pose:
        """Present pose in the body's coordinates."""
        return Pose(body.body_from_world(self.place), tool_turn.as_object(self.turner, scene, body))


def pressers_of(thing: bpy.types.Object, scene: bpy.types.Scene, drawn: DrawnBody) -> list[Presser]:
    """Pressers of a soft object, as they are now.

    Raises
    ------
    PalpateError
        One of them cannot press, or there is none.
    """
    if thing.palpate.pressers is not None:
        return [_of_object(one, thing, scene) for one in thing.palpate.pressers.all_objects]
    tool = chosen_tip(scene, thing, drawn.size).tool
    if tool is None:
        raise PalpateError(
            "finger: a point has no shape to press along an animation; choose Fingertip, Plate, "
            "Rod or Mesh"
        )
    turner = tool_turn.guide_of(scene) if scene.palpate.tip_turn == "OBJECT" else None
    return [Presser(tool, guide, turner or guide) for guide in _leading_objects(scene)]


def _of_object(one: bpy.types.Object, thing: bpy.types.Object, scene: bpy.types.Scene) -> Presser:
    if one == thing:
        raise PalpateError(
            "pressers: {name} cannot press itself; take it out of the collection", name=thing.name
        )
    if one.type == "EMPTY":
        scale = float(np.cbrt(abs(np.linalg.det(np.array(one.matrix_world)[:3, :3]))))
        radius = one.empty_display_size * scale * metres_per_unit(scene)
        return Presser(tools.sphere(radius), one, one)
    if one.type != "MESH":
        raise PalpateError(
            "pressers: {name} is neither a mesh nor an Empty; take it out of the collection",
            name=one.name,
        )
    return Presser(convex(hull.hull_of(one, scene).corners), one, one)


def _leading_objects(scene: bpy.types.Scene) -> tuple[bpy.types.Object, ...]:
    """Objects that lead the scene's fingers: the pressing mesh, or the fingers' Empties."""
    chosen = scene.palpate
    first = chosen.source_empty
    if chosen.tip == "MESH":
        first = first or chosen.tip_object
    first = first or chosen.turn_object
    if first is None:
        raise PalpateError(
            "finger: nothing leads the tool; choose a collection of Pressers, or Press With: Empty "
            "and an animated Empty"
        )
    if chosen.second != "EMPTY":
        return (first,)
    if chosen.second_empty is None:
        raise PalpateError("finger: the second finger has no Empty; pick one under Second Finger")
    if chosen.second_empty == first:
        raise PalpateError(
            "finger: both fingers are led by {name}; choose another Empty for one", name=first.name
        )
    return (first, chosen.second_empty)
