"""One press of an object that nobody holds: it comes to rest, is pressed there, and rests again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.place import nearest_place
from ...core.contact.single_press import set_down
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.errors import PalpateError
from ...core.rest.bearing_points import pressing_points
from ...core.rest.refusals import RestlessError
from ..imprint import kept_imprint
from ..lying.before import Before
from ..lying.coming_down import ROLLS, come_together, show
from ..lying.free_body import Lying
from ..object.drawn_body import DrawnBody
from ..scene.body_frame import as_point
from ..tool import tool_turn
from ..tool.finger_tip import FingerTip
from ..traction.drawn_traction import patches_of, tractions_of
from .pressed import Pressed, PressedFinger

Array = NDArray[np.float64]


def press_resting(
    thing: bpy.types.Object,
    drawn: DrawnBody,
    tip: FingerTip,
    places: Array,
    ways: Array,
    *,
    keep: bool,
) -> Pressed:
    """Let an object come to rest with the soft ones that bear it, set tools down at ``places``
    (m, 3) of the body, metres, and move them by ``ways`` (m, 3), world units, without turning.

    Kept, all lie where they are then; else they are as they were.

    Raises
    ------
    PalpateError
        The tip is a point, or the object cannot move by itself, or does not come to rest.
    """
    if tip.tool is None:
        raise PalpateError(
            "{name}: nothing pins it, and a point cannot press it; choose another Finger, or other "
            "Pins",
            name=thing.name,
        )
    graph = bpy.context.evaluated_depsgraph_get()
    things, coming = come_together(thing, drawn, graph)
    rested = coming.settle()
    starts = [_set_down(graph.scene, drawn, rested[0], tip.tool, place) for place in places]
    steps = ways * drawn.frame.metres_per_unit
    pressed = coming.touched_by([(tip.tool, start) for start in starts])
    try:
        pressed.settle()
        pressed.lead([start.moved(step) for start, step in zip(starts, steps, strict=True)])
        lying = pressed.settle()
    except RestlessError as problem:
        raise PalpateError(ROLLS) from problem
    first, floor = lying[0], coming.supports.floor
    return Pressed(
        fingers=tuple(
            PressedFinger(
                made, as_point(first.frame.turn_to_world(made.force)), float(np.linalg.norm(step))
            )
            for made, step in zip(first.touches, steps, strict=True)
        ),
        largest_displacement=float(
            np.linalg.norm(first.displacements - rested[0].displacements, axis=1).max()
        ),
        layer=_keep(things, drawn, rested, lying, floor) if keep else "",
        remarks=tuple(filter(None, (tip.remark,))),
    )


def _set_down(
    scene: bpy.types.Scene, drawn: DrawnBody, rested: Lying, tool: Tool, at: Array
) -> Pose:
    """Pose in the world of a tool on the surface of a body that rests."""
    body = drawn.body
    place = nearest_place(body, at)
    points, _ = pressing_points(body, tool)
    turn = tool_turn.rotation(scene, rested.frame, -place.axis)
    pose = set_down(body, tool, place, turn, points)
    (sagged,) = drawn.surface_displacements(rested.displacements, place.position[None])
    return rested.in_world(pose.moved(sagged))


def _keep(
    things: Sequence[bpy.types.Object],
    drawn: DrawnBody,
    rested: Sequence[Lying],
    lying: Sequence[Lying],
    floor: float | None,
) -> str:
    """Keep what the press did beyond the sag of rest, and have all lie where they are; the name of
    the layer.
    """
    thing, first, sag = things[0], lying[0], rested[0].moved
    before = [(one, Before.of(one)) for one in things]
    try:
        show(things, [replace(first, moved=sag), *lying[1:]], floor)
        borne = tractions_of(thing, drawn, first.moved, patches_of(first.touches))
        dent = first.moved - sag
        return kept_imprint.keep_moved(thing, bpy.context.scene, drawn.frame, dent, borne)
    except BaseException:
        for one, was in before:
            was.give_back(one)
        raise
