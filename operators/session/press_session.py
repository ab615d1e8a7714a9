"""The press that is going on: events in, effects carried out, one frame drawn at each tick.

Whatever Blender is about to do to the object, the session gives way first: the servo stops with
zero force and the mesh is as it was found.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.tool_surface import surface_for
from ...core.errors import PalpateError
from ...core.servo.session import Snapshot
from ...core.shape.meeting import FingerLoad
from ..device import device_source, servo_words
from ..device.device_source import DeviceFrame
from ..object.drawn_body import DrawnBody, open_body
from ..record import recording_writer
from ..scene import drawn_surface, live_shape
from ..scene.object_handle import ObjectHandle
from ..shape.drawn_shape import DrawnShape, chosen_shape, loads_of
from ..tool import tool_turn
from ..tool.finger_tip import FingerTip, chosen_tip
from .finger_leads import BOTH_POINTER, FingerLead, Lead, leads_of
from .force_loop import ForceLoop
from .live_settings import LiveSettings
from .press_state import (
    BringBack,
    DrawRest,
    Effect,
    Event,
    Fault,
    GiveWay,
    HangLiveShape,
    KeepShape,
    LetGo,
    MoveProbe,
    Phase,
    PlaceProbe,
    Point,
    PressState,
    Recovered,
    RemoveLiveShape,
    Say,
    Source,
    Start,
    StartServo,
    StopServo,
    SwitchForce,
    Turn,
    transition,
)

if TYPE_CHECKING:
    from .pointer_hand import PointerHand

Array = NDArray[np.float64]

KEPT_EARLY = "It is kept as far as it was computed, {share} %"


@dataclass(eq=False)
class PressSession:
    """One press of one object. Make one with :func:`begin`; it is :func:`current` until it ends.

    ``leads`` says who moves which finger, ``tip`` what touches, ``hand`` what the pointer holds.
    ``displacements`` (n, 3) of the free surface nodes are those that are drawn, and ``linear`` what
    the force was computed with; None while nothing touches.
    """

    handle: ObjectHandle
    scene_name: str
    drawn: DrawnBody
    home: DeviceFrame
    leads: tuple[FingerLead, ...] = (FingerLead(Lead.POINTER),)
    tip: FingerTip = field(default_factory=FingerTip)
    hand: PointerHand | None = None
    state: PressState = field(default_factory=PressState)
    loop: ForceLoop | None = None
    snapshot: Snapshot | None = None
    displacements: Array | None = None
    linear: Array | None = None
    kept_name: str = ""
    said: list[Say] = field(default_factory=list)
    _drawn_contact: tuple[object, ...] = ()
    _loads: tuple[FingerLoad, ...] = ()
    _modulus: float = 1.0
    _troubles: list[str] = field(default_factory=list)
    _told: frozenset[str] = frozenset()

    def post(self, event: Event) -> None:
        """Let an event happen: the only way in which a press changes its state."""
        global _current  # noqa: PLW0603  one press at a time is a fact of the module
        self.state, effects = transition(self.state, event)
        try:
            # In order; should one fail, those behind it are still carried out.
            with ExitStack() as waiting:
                for effect in reversed(effects):
                    waiting.callback(self._apply, effect)
        finally:
            if self.state.phase is Phase.ENDED:
                self.shape.close()
                _current = None if _current is self else _current

    def tick(self) -> bool:
        """Follow object, settings and servo, and draw what is new; True if the view changed.

        Raises
        ------
        PalpateError
            The press cannot go on.
        """
        thing = self._object_as_it_is()
        loop = self.loop
        if thing is None or loop is None:
            return True
        loop.follow(self._settings(thing, loop.settings.device))
        self._lead_fingers(loop)
        snapshot = loop.snapshot()
        moved = self.snapshot is None or snapshot.tick != self.snapshot.tick
        self.snapshot = snapshot
        self._watch_faults(snapshot)
        self._tell_troubles(loop)
        if self.state.phase is not Phase.LOST and not self.state.withdrawn:
            self._draw(thing, snapshot)
        return moved

    def switch_force(self) -> None:
        """Let the device's force go at once, or let it rise again."""
        now = time.monotonic()
        self.post(LetGo(now) if self.state.force_on else BringBack(now))

    def start_recording(self) -> None:
        """Record from here on.

        Raises
        ------
        PalpateError
            One is going on, or the servo refuses.
        """
        if self.loop is not None:
            now = 0.0 if self.snapshot is None else self.snapshot.time
            self.loop.recorder.start(60.0 * self.scene.palpate.record_minutes, now)
            recording_writer.forget()

    @property
    def scene(self) -> bpy.types.Scene:
        """The scene in which the press began, or the one of now if that is gone."""
        return bpy.data.scenes.get(self.scene_name) or bpy.context.scene

    @property
    def pinches(self) -> bool:
        """Whether the pointer has two handles."""
        return self.leads == BOTH_POINTER

    @property
    def has_device(self) -> bool:
        """Whether a device leads one of the fingers."""
        return self.state.has_device

    @property
    def awaits_device(self) -> bool:
        """Whether a device leads that has not said yet where it is."""
        waiting = self.snapshot is not None and self.snapshot.state == "waiting"
        return self.state.phase is Phase.FEELING and waiting

    @cached_property
    def shape(self) -> DrawnShape:
        """What is drawn of the body under its fingers."""
        return DrawnShape(self.drawn.body, self.drawn.file)

    @cached_property
    def surface_samples(self) -> Array:
        """Places (n, 3) spread over the surface at rest, as closely as the tool needs, metres."""
        tool = self.tip.tool
        if tool is None:
            return self.drawn.surface_nodes
        return surface_for(self.drawn.body, tool).positions

    def surface_now(self) -> Array:
        """All nodes of the body as they are seen, (N, 3), body coordinates."""
        nodes = self.drawn.body.mesh.nodes
        if self.displacements is None:
            return nodes
        return nodes + self.drawn.node_displacements(self.displacements)

    def _apply(self, effect: Effect) -> None:
        match effect:
            case HangLiveShape():
                self._with_object(live_shape.hang)
                self._drawn_contact = ()
            case StartServo(source):
                self._start_loop(source)
            case PlaceProbe() | MoveProbe() | SwitchForce():
                self._running.carry_out(effect)
            case DrawRest():
                self.displacements, self.linear, self._drawn_contact = None, None, ()
                self._with_object(lambda thing: live_shape.write(thing.data, self.drawn.rest))
            case StopServo():
                self._stop_loop()
            case RemoveLiveShape():
                self._with_object(_leave_edit_mode)
                self._with_object(live_shape.remove)
            case KeepShape():
                self._with_object(self._keep)
            case Say():
                self.said.append(effect)

    @property
    def _running(self) -> ForceLoop:
        if self.loop is None:
            raise RuntimeError("the press has no force loop; it was not started")
        return self.loop

    def _with_object(self, act: Callable[[bpy.types.Object], object]) -> None:
        thing = self.handle.find()
        if thing is not None:
            act(thing)

    def _keep(self, thing: bpy.types.Object) -> None:
        if self._loads and not self._drawn_contact:
            # What was drawn last lacks something that is still being computed.
            met = self.shape.finish(self._loads, self._modulus)
            if self.shape.ready < 1.0:
                share = f"{100 * self.shape.ready:.0f}"
                text = bpy.app.translations.pgettext_iface(KEPT_EARLY).format(share=share)
                self.said.append(Say(text, warning=True))
            tools = () if self.snapshot is None else self.tip.pressing(self.snapshot)
            live_shape.write(thing.data, self.drawn.local_coordinates(met.displacements, tools))
        self.kept_name = live_shape.keep(thing)
        thing.data.update()

    def _start_loop(self, source: Source) -> None:
        scene, thing = self.scene, self.handle.find()
        if thing is None:
            raise PalpateError(f"{self.handle.name} is gone; choose another object")
        frame = None
        if source is Source.DEVICE:
            frame = device_source.device_frame(scene, self.drawn.frame, self.home)
        settings = LiveSettings.of(thing, scene, frame)
        fingers, rate = len(self.leads), scene.palpate.rate
        self.loop = ForceLoop.prepare(self.drawn, settings, rate, self.tip, fingers)
        for lead in self.leads[1:]:
            if lead.lead is Lead.DEVICE:
                self.loop.add_device(thing, scene)
            else:
                self.loop.add_pointer(self._start_of(lead))
        self.loop.give_tools(fingers)
        if scene.palpate.record_from_start:
            # All fingers are there: memory for each is asked for now.
            self.start_recording()
        if source is Source.DEVICE:
            self.loop.start_device(scene, self.drawn)
        else:
            self.loop.start_pointer(self._start_of(self.leads[0]))
        self._lead_fingers(self.loop)

    def _start_of(self, lead: FingerLead) -> Point:
        """Where a finger begins: at its Empty, or outside the body, where the pointer's waits."""
        empty = lead.empty.find() if lead.empty is not None else None
        if empty is not None:
            return self._place_of(empty)
        x, y, z = self.drawn.body.mesh.nodes.mean(axis=0).tolist()
        return (x, y, z + self.drawn.size)

    def _place_of(self, empty: bpy.types.Object) -> Point:
        x, y, z = self.drawn.frame.body_from_world(np.array(empty.matrix_world)[:3, 3]).tolist()
        return (x, y, z)

    def _lead_fingers(self, loop: ForceLoop) -> None:
        """Where Empties are now, and how tools are turned that the pointer does not turn."""
        for finger, lead in enumerate(self.leads):
            empty = lead.empty.find() if lead.empty is not None else None
            if lead.empty is not None and empty is None:
                self._troubles.append(
                    f"{lead.empty.name} was deleted; its finger stays where it was"
                )
            place = None if empty is None else self._place_of(empty)
            loop.lead(finger, place, self._turn_of(lead, empty))

    def _turn_of(self, lead: FingerLead, empty: bpy.types.Object | None) -> Turn | None:
        """As an object or as the Empty that leads; None as it was. A device turns its own."""
        scene = self.scene
        leader = tool_turn.guide_of(scene) if scene.palpate.tip_turn == "OBJECT" else None
        leader = leader or empty
        if self.tip.tool is None or leader is None or lead.lead is Lead.DEVICE:
            return None
        try:
            return tool_turn.as_rows(tool_turn.as_object(leader, scene, self.drawn.frame))
        except PalpateError as problem:
            self._troubles.append(str(problem))
            return None

    def _stop_loop(self) -> None:
        loop, self.loop = self.loop, None
        if loop is not None:
            loop.stop()

    def _object_as_it_is(self) -> bpy.types.Object | None:
        """The object, if the press may go on with it; else the press gives way."""
        thing = self.handle.find()
        reason = ""
        if thing is None:
            reason = f"{self.handle.name} was deleted; pressing has ended"
        elif thing.mode != "OBJECT":
            reason = f"{thing.name} is being edited; pressing has ended"
        elif 3 * len(thing.data.vertices) != len(self.drawn.rest):
            reason = f"{thing.name} was edited; press Make Soft to bake it again"
        elif not self._follow_frame(thing):
            reason = f"{thing.name} was scaled; press Make Soft to bake it again"
        if reason:
            self.post(GiveWay(reason))
            return None
        return thing

    def _follow_frame(self, thing: bpy.types.Object) -> bool:
        try:
            moved = self.drawn.moved_to(drawn_surface.frame_of(thing, self.scene))
        except PalpateError:
            # Flattened to nothing: that is a change of scale too.
            return False
        if moved is not None:
            self.drawn = moved
        return moved is not None

    def _settings(self, thing: bpy.types.Object, before: DeviceFrame | None) -> LiveSettings:
        """As they are now; a device stays where it was while its Empty says nothing of use."""
        scene, frame = self.scene, before
        if before is not None:
            try:
                frame = device_source.device_frame(scene, self.drawn.frame, self.home)
            except PalpateError as problem:
                self._troubles.append(str(problem))
        return LiveSettings.of(thing, scene, frame)

    def _tell_troubles(self, loop: ForceLoop) -> None:
        """Say each trouble when it begins, not in every frame."""
        shape, felt = self.shape, loop.felt
        found = (*self._troubles, felt.problem, felt.notice, shape.problem, shape.notice)
        # The same may be found for both fingers.
        texts = [text for text in dict.fromkeys(found) if text]
        self.said += [Say(text, warning=True) for text in texts if text not in self._told]
        self._told, self._troubles = frozenset(texts), []

    def _watch_faults(self, snapshot: Snapshot) -> None:
        if snapshot.fault:
            text = servo_words.fault_text(snapshot.fault)
            if snapshot.state == "stopped":
                # Nothing brings it back.
                self.post(GiveWay(text))
            elif text != self.state.message:
                self.post(Fault(text))
        elif self.state.phase is Phase.LOST:
            self.post(Recovered())

    def _draw(self, thing: bpy.types.Object, snapshot: Snapshot) -> None:
        self.shape.follow(chosen_shape(thing))
        modulus = self._running.settings.young_modulus
        fingers = tuple(
            (finger.touching, finger.nodes.tobytes(), finger.nodal_forces.tobytes())
            for finger in snapshot.fingers
        )
        contact = (self.shape.name, self.shape.ready, modulus, fingers)
        if contact == self._drawn_contact:
            return
        self._drawn_contact = contact
        self._loads, self._modulus = tuple(loads_of(self.drawn.body, snapshot)), modulus
        if not self._loads:
            self.displacements = self.linear = None
            live_shape.write(thing.data, self.drawn.rest)
            return
        met = self.shape.draw(self._loads, modulus)
        if not met.settled or self.shape.ready < 1.0:
            # The same contact is drawn better in the next frame.
            self._drawn_contact = ()
        self.displacements, self.linear = met.displacements, met.linear
        tools = self.tip.pressing(snapshot)
        live_shape.write(thing.data, self.drawn.local_coordinates(met.displacements, tools))


_current: PressSession | None = None


def current() -> PressSession | None:
    """The press that is going on, if one is."""
    return _current


def begin(
    thing: bpy.types.Object, scene: bpy.types.Scene, source: Source, *, pinch: bool = False
) -> PressSession:
    """Start to press an object; with ``pinch`` the pointer has two handles.

    Raises
    ------
    PalpateError
        A press is going on; the object or its body does not allow it; the device does not; the
        tool or the Empty that the scene asks for is not there.
    """
    global _current  # noqa: PLW0603  see PressSession.post
    if _current is not None:
        raise PalpateError(f"{_current.handle.name} is being pressed; end that first (Escape)")
    leads = BOTH_POINTER if pinch else leads_of(scene, source)
    tip = chosen_tip(scene, thing)
    drawn = open_body(thing, scene)
    home = device_source.home_of_device(thing, scene, drawn.frame)
    session = PressSession(ObjectHandle.of(thing), scene.name, drawn, home, leads, tip)
    if tip.remark:
        session.said.append(Say(tip.remark, warning=True))
    _current = session
    try:
        session.post(Start(source, device=any(lead.lead is Lead.DEVICE for lead in leads)))
    except BaseException:
        session.post(GiveWay(""))
        raise
    return session


def give_way(reason: str) -> None:
    """End the press that is going on, if one is, leaving the mesh clean."""
    if _current is not None:
        _current.post(GiveWay(reason))


def _leave_edit_mode(thing: bpy.types.Object) -> None:
    """Shape keys can only be taken away while nobody edits them."""
    if thing.mode == "OBJECT":
        return
    with bpy.context.temp_override(active_object=thing, object=thing):
        bpy.ops.object.mode_set(mode="OBJECT")
