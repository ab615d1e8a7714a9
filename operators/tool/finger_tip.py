"""Chosen finger tip, from scene units to metres."""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy

from ...core.contact.tool import tools
from ...core.contact.tool.convex_tool import convex
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tool_dent import PressingTool
from ...core.contact.tool.tools import Tool
from ...core.errors import PalpateError
from ...core.servo.session import Snapshot
from . import hull
from .tool_sizes import chosen_sizes

# Share of a tool's width that is pressed in at most.
SEEN = 0.75


@dataclass(frozen=True, eq=False)
class FingerTip:
    """Finger tip: ``tool`` in metres, None for a point; ``remark`` on a much changed mesh."""

    tool: Tool | None = None
    remark: str = ""

    @property
    def deepest(self) -> float:
        """How far in it is led by the pointer, metres: so far that the tool is still seen. Twice
        as deep a linear body lets go of it.
        """
        return math.inf if self.tool is None else SEEN * self.tool.size

    def pressing(self, snapshot: Snapshot) -> tuple[PressingTool, ...]:
        """Tools pressing in a snapshot, for drawing."""
        if self.tool is None:
            return ()
        return tuple(
            PressingTool(self.tool, Pose(finger.proxy, finger.orientation), finger.contact_force)
            for finger in snapshot.fingers
            if finger.touching
        )


def chosen_tip(
    scene: bpy.types.Scene,
    pressed: bpy.types.Object,
    size: float,
    graph: bpy.types.Depsgraph | None = None,
) -> FingerTip:
    """Finger tip that the scene chooses for ``pressed``, a body of this ``size``, metres; a mesh as
    a graph has it, without one as the view does.

    Raises
    ------
    PalpateError
        No tool object is chosen, or it cannot press, or it is what is pressed.
    """
    chosen, sizes = scene.palpate, chosen_sizes(scene, size)
    match chosen.tip:
        case "SPHERE":
            return FingerTip(tools.sphere(sizes.tip_radius))
        case "PLATE":
            return FingerTip(tools.plate(sizes.plate_width, sizes.plate_depth))
        case "ROD":
            return FingerTip(tools.rod(sizes.tip_radius, sizes.rod_length))
        case "MESH":
            if chosen.tip_object == pressed:
                raise PalpateError(
                    "tool: {name} cannot press itself; choose another mesh as the tool",
                    name=pressed.name,
                )
            return _of_object(chosen.tip_object, scene, graph)
    return FingerTip()


def _of_object(
    thing: bpy.types.Object | None, scene: bpy.types.Scene, graph: bpy.types.Depsgraph | None
) -> FingerTip:
    if thing is None or thing.name not in scene.objects:
        raise PalpateError("tool: no mesh object is chosen; pick one under Finger")
    shape = hull.hull_of(thing, scene, graph)
    return FingerTip(convex(shape.corners), shape.remark)
