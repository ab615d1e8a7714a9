"""Pressers: the objects that press through an animation, each a tool with a pose.

They are those of the collection that the soft object names, or else what leads the scene's fingers.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ....core.contact.tool import tools
from ....core.contact.tool.convex_tool import convex
from ....core.contact.tool.pose import Pose
from ....core.contact.tool.tools import Tool
from ....core.errors import PalpateError
from ...object.drawn_body import DrawnBody
from ...place.evaluation import evaluated
from ...scene.body_frame import BodyFrame
from ...scene.drawn_surface import metres_per_unit
from ...tool import hull, tool_turn
from ...tool.finger_tip import chosen_tip


@dataclass(frozen=True, eq=False)
class Presser:
    """Tool where an object is.

    Attributes
    ----------
    place : float64 (3,), world coordinates.
    axes : float64 (3, 3), the rotation of its axes in the world.
    """

    tool: Tool
    place: NDArray[np.float64]
    axes: NDArray[np.float64]

    @classmethod
    def at(cls, tool: Tool, guide: bpy.types.Object, turner: bpy.types.Object) -> Presser:
        """The tool where ``guide`` is, turned as ``turner``; both evaluated."""
        place = np.array(guide.matrix_world, dtype=np.float64)[:3, 3]
        return cls(tool, place, tool_turn.axes_of(turner))

    def pose(self, body: BodyFrame) -> Pose:
        """Its pose in the body's coordinates."""
        return Pose(body.body_from_world(self.place), body.rotation.T @ self.axes)


def pressers_of(
    thing: bpy.types.Object, graph: bpy.types.Depsgraph, drawn: DrawnBody
) -> list[Presser]:
    """Pressers of a soft object where a graph has them.

    Raises
    ------
    PalpateError
        One of them cannot press, or there is none.
    """
    scene = graph.scene
    chosen = thing.palpate.pressers
    if chosen is not None:
        if not chosen.all_objects:
            raise PalpateError(
                "pressers: nothing is in {name}; put meshes or Empties into this collection",
                name=chosen.name,
            )
        return [_of_object(one, thing, graph) for one in chosen.all_objects]
    tool = chosen_tip(scene, thing, drawn.size, graph).tool
    if tool is None:
        raise PalpateError(
            "finger: a point has no shape to press along an animation; choose Fingertip, Plate, "
            "Rod or Mesh"
        )
    turner = tool_turn.guide_of(scene) if scene.palpate.tip_turn == "OBJECT" else None
    guides = [evaluated(guide, graph) for guide in _leading_objects(scene)]
    turned = None if turner is None else evaluated(turner, graph)
    return [Presser.at(tool, guide, turned or guide) for guide in guides]


def _of_object(
    one: bpy.types.Object, thing: bpy.types.Object, graph: bpy.types.Depsgraph
) -> Presser:
    scene = graph.scene
    if one == thing:
        raise PalpateError(
            "pressers: {name} cannot press itself; take it out of the collection", name=thing.name
        )
    if one.type == "EMPTY":
        seen = evaluated(one, graph)
        scale = float(np.cbrt(abs(np.linalg.det(np.array(seen.matrix_world)[:3, :3]))))
        radius = seen.empty_display_size * scale * metres_per_unit(scene)
        return Presser.at(tools.sphere(radius), seen, seen)
    if one.type != "MESH":
        raise PalpateError(
            "pressers: {name} is neither a mesh nor an Empty; take it out of the collection",
            name=one.name,
        )
    seen = evaluated(one, graph)
    return Presser.at(convex(hull.hull_of(one, scene, graph).corners), seen, seen)


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
