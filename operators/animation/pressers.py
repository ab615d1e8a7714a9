"""Pressers: the objects that lead tools through an animation, and their poses."""

from __future__ import annotations

import bpy
import numpy as np

from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.errors import PalpateError
from ..scene.body_frame import BodyFrame
from ..tool import tool_turn
from ..tool.finger_tip import chosen_tip


def tool_of(scene: bpy.types.Scene, thing: bpy.types.Object, size: float) -> Tool:
    """The tool that presses, on a body of this ``size``, metres.

    Raises
    ------
    PalpateError
        The finger is a point.
    """
    tool = chosen_tip(scene, thing, size).tool
    if tool is None:
        raise PalpateError(
            "finger: a point has no shape to press along an animation; choose Fingertip, Plate, "
            "Rod or Mesh"
        )
    return tool


def leading_objects(scene: bpy.types.Scene) -> tuple[bpy.types.Object, ...]:
    """Objects that lead the tools: the pressing mesh, or the fingers' Empties.

    Raises
    ------
    PalpateError
        Nothing does, or both fingers are led by the same object.
    """
    chosen = scene.palpate
    first = chosen.source_empty
    if chosen.tip == "MESH":
        first = first or chosen.tip_object
    first = first or chosen.turn_object
    if first is None:
        raise PalpateError(
            "finger: nothing leads the tool; choose Press With: Empty and an animated Empty"
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


def pose_of(guide: bpy.types.Object, scene: bpy.types.Scene, body: BodyFrame) -> Pose:
    """Pose of the tool that ``guide`` leads, in the body's coordinates."""
    place = body.body_from_world(np.array(guide.matrix_world)[:3, 3])
    turner = tool_turn.guide_of(scene) if scene.palpate.tip_turn == "OBJECT" else None
    return Pose(place, tool_turn.as_object(turner or guide, scene, body))
