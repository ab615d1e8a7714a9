"""Force loop with all fingers, and targets of those led by Empties and objects."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ...core.servo.session import Snapshot
from ..object.drawn_body import DrawnBody
from ..record import recording_writer
from ..scene.body_frame import BodyFrame, as_point
from ..scene.object_handle import ObjectHandle
from ..tool import tool_turn
from ..tool.finger_tip import FingerTip
from ..tool.tool_turn import Point, Turn
from .finger_leads import FingerLead, Lead
from .force_loop import ForceLoop
from .live_settings import LiveSettings

Array = NDArray[np.float64]


def start_loop(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    drawn: DrawnBody,
    settings: LiveSettings,
    leads: Sequence[FingerLead],
    tip: FingerTip,
) -> ForceLoop:
    """Running loop for these fingers, recorded from its start if the scene chooses so.

    Raises
    ------
    PalpateError
        The body cannot be touched, a device is not there, or the servo refuses a setting.
    """
    loop = ForceLoop.prepare(drawn, settings, scene.palpate.rate, tip, len(leads))
    loop.recorder.pressed = ObjectHandle.of(thing)
    try:
        for lead in leads[1:]:
            if lead.lead is Lead.DEVICE:
                loop.add_device(thing, scene)
            else:
                loop.add_pointer(_start_of(lead, drawn))
        loop.give_tools(len(leads))
        if scene.palpate.record_from_start:
            # With all fingers added: memory is reserved for each.
            record(loop, scene, 0.0)
        if settings.device is not None:
            loop.start_device(scene, drawn)
        else:
            loop.start_pointer(_start_of(leads[0], drawn))
    except BaseException:
        loop.stop()
        raise
    return loop


def record(loop: ForceLoop, scene: bpy.types.Scene, now: float) -> None:
    """Start recording at ``now`` (s, servo's time).

    Raises
    ------
    PalpateError
        A recording is going on, or the servo refuses.
    """
    loop.recorder.start(60.0 * scene.palpate.record_minutes, now)
    recording_writer.forget()


def lead_fingers(
    loop: ForceLoop, leads: Sequence[FingerLead], scene: bpy.types.Scene, drawn: DrawnBody
) -> list[str]:
    """Move fingers to their Empties, and rotate tools not rotated by the pointer.

    Returns a sentence for each obstacle.
    """
    troubles: list[str] = []
    for finger, lead in enumerate(leads):
        empty = lead.empty.find() if lead.empty is not None else None
        if lead.empty is not None and empty is None:
            troubles.append(
                Sentence("{name} was deleted; its finger stays where it was", name=lead.empty.name)
            )
        turn = None
        try:
            turn = _turn_of(lead, empty, loop, scene, drawn)
        except PalpateError as problem:
            troubles.append(problem.sentence)
        loop.lead(finger, None if empty is None else _place_of(empty, drawn), turn)
    return troubles


def led_place(lead: FingerLead, snapshot: Snapshot | None, frame: BodyFrame) -> Array | None:
    """Where a finger of an Empty or a device is, world coordinates; None while it touches, and for
    the pointer's, which stays with what it touched.
    """
    if lead.lead is Lead.POINTER or (snapshot is not None and snapshot.touching):
        return None
    empty = lead.empty.find() if lead.empty is not None else None
    if empty is not None:
        return np.array(empty.matrix_world)[:3, 3]
    return None if snapshot is None else frame.world_from_body(snapshot.fingers[0].probe)


def _start_of(lead: FingerLead, drawn: DrawnBody) -> Point:
    """Start of a finger: at its Empty, or outside the body for the pointer."""
    empty = lead.empty.find() if lead.empty is not None else None
    if empty is not None:
        return _place_of(empty, drawn)
    x, y, z = drawn.body.mesh.nodes.mean(axis=0).tolist()
    return (x, y, z + drawn.size)


def _place_of(empty: bpy.types.Object, drawn: DrawnBody) -> Point:
    return as_point(drawn.frame.body_from_world(np.array(empty.matrix_world)[:3, 3]))


def _turn_of(
    lead: FingerLead,
    empty: bpy.types.Object | None,
    loop: ForceLoop,
    scene: bpy.types.Scene,
    drawn: DrawnBody,
) -> Turn | None:
    """Rotation of an object or the leading Empty; None for no change. Devices have their own."""
    leader = tool_turn.guide_of(scene) if scene.palpate.tip_turn == "OBJECT" else None
    leader = leader or empty
    if loop.tip.tool is None or leader is None or lead.lead is Lead.DEVICE:
        return None
    return tool_turn.as_rows(tool_turn.as_object(leader, drawn.frame))
