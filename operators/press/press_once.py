"""One press without pointer, device or clock: for scripts, command line and background Blender."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.contact.place import nearest_place
from ...core.contact.press import ContactSettings
from ...core.contact.single_press import press_points, press_tools, set_down
from ...core.contact.tool.tool_dent import PressingTool
from ...core.contact.tool.tools import Tool
from ...core.contact.touches import ToolTouch, Touch
from ...core.errors import PalpateError
from ...core.shape.felt import felt, loads_of
from ...core.shape.meeting import settled
from ..imprint import kept_imprint
from ..layer import place_marks
from ..object.drawn_body import DrawnBody, open_body
from ..place import touched_place
from ..place.touched_place import TouchedPlace
from ..scene.body_frame import BodyFrame, as_point
from ..session.live_settings import contact_mode
from ..shape.drawn_shape import closing_shape
from ..tool import tool_turn
from ..tool.finger_tip import FingerTip, chosen_tip
from ..traction.drawn_traction import patches_of, tractions_of
from .press_resting import press_resting
from .pressed import Pressed, PressedFinger

Array = NDArray[np.float64]


def press_once(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    at: ArrayLike,
    by: ArrayLike,
    *,
    keep: bool = True,
) -> Pressed:
    """Press the surface point nearest to ``at`` by ``by`` (3,), world units; keep a layer.

    Raises
    ------
    PalpateError
        The object cannot be pressed, or a coordinate is not finite.
    """
    return press_several(thing, scene, [at], [by], keep=keep)


def press_several(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    ats: Sequence[ArrayLike],
    bys: Sequence[ArrayLike],
    *,
    keep: bool = True,
) -> Pressed:
    """Press with several fingers at once, each from the surface point nearest to its ``at`` by its
    ``by``; with the contact mode and the tip that the scene says.

    Raises
    ------
    PalpateError
        The object cannot be pressed, a coordinate is not finite, or the tool cannot be used.
    """
    drawn = open_body(thing, scene)
    tip = chosen_tip(scene, thing, drawn.size)
    points = [_point(at, "at") for at in ats]
    ways = [_point(by, "by") for by in bys]
    found = _seen_places(thing, drawn, points)
    places = np.array(
        [
            _point(drawn.frame.body_from_world(point), "at") if place is None else place.rest
            for place, point in zip(found, points, strict=True)
        ]
    )
    if drawn.body.is_free:
        return press_resting(thing, drawn, tip, places, np.array(ways), keep=keep)
    frames = [drawn.frame if place is None else place.frame(drawn.frame) for place in found]
    return _press_pinned(thing, scene, drawn, tip, places, ways, frames, keep=keep)


def _press_pinned(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    drawn: DrawnBody,
    tip: FingerTip,
    places: Array,
    ways: Sequence[Array],
    frames: Sequence[BodyFrame],
    *,
    keep: bool,
) -> Pressed:
    """Press of an object that its pins hold; ``frames`` are those where it is touched, as seen."""
    young_modulus = thing.palpate.young_modulus
    inward = np.array(
        [one.turn_to_body(way) * one.metres_per_unit for one, way in zip(frames, ways, strict=True)]
    )
    made = _touches(thing, scene, drawn, tip.tool, places, inward, frames)
    with closing_shape(thing, drawn) as shape:
        met = settled(drawn.body, shape, loads_of(made), young_modulus)
        if contact_mode(scene) != "paper":
            made = felt(shape, made, young_modulus).touches
    moved = drawn.drawn_displacement(met.displacements, pressing_tools(made))
    borne = tractions_of(thing, drawn, moved, patches_of(made))
    return Pressed(
        fingers=tuple(
            PressedFinger(one, as_point(local.turn_to_world(one.force)), float(np.linalg.norm(way)))
            for one, local, way in zip(made, frames, inward, strict=True)
        ),
        largest_displacement=float(np.linalg.norm(met.displacements, axis=1).max()),
        layer=kept_imprint.keep_moved(thing, scene, drawn.frame, moved, borne) if keep else "",
        remarks=tuple(filter(None, (tip.remark, shape.notice))),
    )


def _seen_places(
    thing: bpy.types.Object, drawn: DrawnBody, points: Sequence[Array]
) -> list[TouchedPlace | None]:
    """Places as seen nearest to points (3,), world coordinates; None where that is at rest."""
    if touched_place.is_seen_at_rest(thing):
        return [None for _ in points]
    with place_marks.marked(thing):
        return [touched_place.nearest(thing, drawn.frame, point) for point in points]


def _touches(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    drawn: DrawnBody,
    tool: Tool | None,
    places: Array,
    inward: Array,
    frames: Sequence[BodyFrame],
) -> tuple[Touch, ...]:
    """Points, or tools each set down at its place from outside and led in; ``frames`` are the local
    ones.
    """
    body, chosen = drawn.body, thing.palpate
    settings = ContactSettings(chosen.young_modulus, chosen.static_friction, contact_mode(scene))
    if tool is None:
        return press_points(body, places, inward, settings)
    nearest = [nearest_place(body, place) for place in places]
    turns = [
        tool_turn.rotation(scene, frame, -place.axis)
        for frame, place in zip(frames, nearest, strict=True)
    ]
    starts = [set_down(body, tool, *one) for one in zip(nearest, turns, strict=True)]
    return press_tools(body, tool, starts, inward, settings)


def pressing_tools(touches: Sequence[Touch]) -> tuple[PressingTool, ...]:
    """The tools among the fingers, for drawing."""
    return tuple(
        PressingTool(one.tool, one.pose, one.force) for one in touches if isinstance(one, ToolTouch)
    )


def _point(value: ArrayLike, name: str) -> Array:
    point = np.asarray(value, dtype=np.float64)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise PalpateError(
            "{name}: {point} is not a point; give three finite numbers",
            name=name,
            point=point.tolist(),
        )
    return point
