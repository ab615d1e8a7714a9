"""Force loop with all fingers, and targets of those led by Empties and objects."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ...core.servo.session import FingerSnapshot, Snapshot
from ..device import device_source
from ..device.device_source import DeviceFrame
from ..lying.pressed.pressed_prop import PressedProp
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
    frames: Sequence[BodyFrame],
    tip: FingerTip,
    prop: PressedProp | None = None,
) -> ForceLoop:
    """Running loop for these fingers, each in the frame of its hand, recorded from its start if
    the scene chooses so.

    Raises
    ------
    PalpateError
        The body cannot be touched, a device is not there, or the servo refuses a setting.
    """
    loop = ForceLoop.prepare(drawn, settings, scene.palpate.rate, tip, len(leads), prop)
    loop.recorder.pressed = ObjectHandle.of(thing)
    try:
        for lead, frame in zip(leads[1:], frames[1:], strict=True):
            if lead.lead is Lead.DEVICE:
                loop.add_device(scene, frame)
            else:
                loop.add_pointer(_start_of(lead, drawn, frame))
        loop.give_tools(len(leads))
        if scene.palpate.record_from_start:
            # With all fingers added: memory is reserved for each.
            record(loop, scene, 0.0)
        if leads[0].lead is Lead.DEVICE:
            loop.start_device(scene, frames[0])
        else:
            loop.start_pointer(_start_of(leads[0], drawn, frames[0]))
    except BaseException:
        loop.stop()
        raise
    return loop


def homes_of(
    thing: bpy.types.Object, scene: bpy.types.Scene, frame: BodyFrame, leads: Sequence[FingerLead]
) -> tuple[DeviceFrame | None, ...]:
    """Frame of each finger's device where no Empty places it; None without a device."""
    return tuple(
        device_source.home_of_device(thing, scene, frame, finger)
        if lead.lead is Lead.DEVICE
        else None
        for finger, lead in enumerate(leads)
    )


def present_settings(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    homes: Sequence[DeviceFrame | None],
    frames: Sequence[BodyFrame],
    of_object: BodyFrame,
    before: Sequence[DeviceFrame | None] = (),
) -> tuple[LiveSettings, list[str]]:
    """Settings as they are now, and a sentence for each obstacle: a device keeps its frame of
    ``before`` while its Empty is unusable. ``frames`` are the hands', ``of_object`` is where homes
    are.

    Raises
    ------
    PalpateError
        The Empty is unusable, and there is no frame from before.
    """
    devices: list[DeviceFrame | None] = []
    troubles: list[str] = []
    for finger, (home, local) in enumerate(zip(homes, frames, strict=True)):
        found = None
        if home is not None:
            try:
                found = device_source.device_frame(thing, scene, local, home, finger, of_object)
            except PalpateError as problem:
                if not before:
                    raise
                found = before[finger]
                troubles.append(problem.sentence)
        devices.append(found)
    return LiveSettings.of(thing, scene, tuple(devices)), troubles


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
    loop: ForceLoop,
    leads: Sequence[FingerLead],
    scene: bpy.types.Scene,
    frames: Sequence[BodyFrame],
) -> list[str]:
    """Move fingers to their Empties, each in its local frame, and rotate tools not rotated by the
    pointer.

    Returns a sentence for each obstacle.
    """
    troubles: list[str] = []
    for finger, (lead, frame) in enumerate(zip(leads, frames, strict=True)):
        empty = lead.empty.find() if lead.empty is not None else None
        if lead.empty is not None and empty is None:
            troubles.append(
                Sentence("{name} was deleted; its finger stays where it was", name=lead.empty.name)
            )
        turn = None
        try:
            turn = _turn_of(lead, empty, loop, scene, frame)
        except PalpateError as problem:
            troubles.append(problem.sentence)
        loop.lead(finger, None if empty is None else _place_of(empty, frame), turn)
    return troubles


def free_places(
    leads: Sequence[FingerLead], snapshot: Snapshot | None, frames: Sequence[BodyFrame]
) -> list[Array | None]:
    """Where fingers of Empties and devices are that touch nothing, (3,), world coordinates; None
    for the others. ``frames`` are the fingers' local ones.
    """
    told = (None,) * len(leads) if snapshot is None else snapshot.fingers
    return [_free_place(*one) for one in zip(leads, told, frames, strict=True)]


def _free_place(lead: FingerLead, finger: FingerSnapshot | None, frame: BodyFrame) -> Array | None:
    """Where a finger of an Empty or a device is, world coordinates; None while it touches, and for
    the pointer's, which stays with what it touched. ``frame`` is its local one.
    """
    if lead.lead is Lead.POINTER or (finger is not None and finger.touching):
        return None
    empty = lead.empty.find() if lead.empty is not None else None
    if empty is not None:
        return np.array(empty.matrix_world)[:3, 3]
    return None if finger is None else frame.world_from_body(finger.probe)


def _start_of(lead: FingerLead, drawn: DrawnBody, frame: BodyFrame) -> Point:
    """Start of a finger: at its Empty, or outside the body for the pointer."""
    empty = lead.empty.find() if lead.empty is not None else None
    if empty is not None:
        return _place_of(empty, frame)
    middle = drawn.frame.world_from_body(drawn.body.mesh.nodes.mean(axis=0))
    x, y, z = frame.body_from_world(middle).tolist()
    return (x, y, z + drawn.size)


def _place_of(empty: bpy.types.Object, frame: BodyFrame) -> Point:
    return as_point(frame.body_from_world(np.array(empty.matrix_world)[:3, 3]))


def _turn_of(
    lead: FingerLead,
    empty: bpy.types.Object | None,
    loop: ForceLoop,
    scene: bpy.types.Scene,
    frame: BodyFrame,
) -> Turn | None:
    """Rotation of an object or the leading Empty; None for no change. Devices have their own."""
    leader = tool_turn.guide_of(scene) if scene.palpate.tip_turn == "OBJECT" else None
    leader = leader or empty
    if loop.tip.tool is None or leader is None or lead.lead is Lead.DEVICE:
        return None
    return tool_turn.as_rows(tool_turn.as_object(leader, frame))
