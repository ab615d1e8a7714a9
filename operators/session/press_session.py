"""Session of the running press: handles events, carries out effects, draws a frame at each tick.

Before anything else happens to the object, the session ends: the servo stops with zero force and
the mesh is restored.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cached_property

import bpy

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ...core.servo.session import Snapshot
from ..device import servo_words
from ..layer import live_layer, place_marks
from ..lying.pressed.pressed_prop import PressedProp
from ..object.drawn_body import open_body
from ..record.recording import Recorder
from ..scene.object_handle import ObjectHandle
from ..tool.finger_tip import FingerTip, chosen_tip
from ..tool.tool_depth import finger_depth
from .finger_leads import BOTH_POINTER, Lead, leads_of
from .force_loop import ForceLoop
from .led_loop import homes_of, lead_fingers, present_settings, record, start_loop
from .press_effects import Act, Effect, Say, StartServo, SwitchForce
from .press_events import (
    BringBack,
    Event,
    Fault,
    GiveWay,
    LetGo,
    Moment,
    Move,
    SetDown,
    Source,
    Start,
)
from .press_state import Phase, PressState, transition
from .pressed_object import PressedObject, reason_to_end
from .seen_body import SeenBody


@dataclass(eq=False)
class PressSession(PressedObject):
    """Press of one object. Make one with :func:`begin`; it is :func:`current` until it ends.

    ``tip`` is the fingers' tool or point, ``seen`` the drawn body, ``area`` the address of the 3D
    view where it began, 0 for none. ``kept`` says that the object was left as it was pressed, as
    the layer ``kept_name`` where a finger did so then.
    """

    tip: FingerTip = field(default_factory=FingerTip)
    state: PressState = field(default_factory=PressState)
    loop: ForceLoop | None = None
    kept: bool = False
    kept_name: str = ""
    area: int = 0
    said: list[Say] = field(default_factory=list)
    _problems: list[str] = field(default_factory=list)
    _reported: frozenset[str] = frozenset()

    def post(self, event: Event) -> None:
        """Handle an event: the only way to change the state of a press."""
        global _current  # noqa: PLW0603  one press at a time
        self.state, effects = transition(self.state, event)
        try:
            # In order; if one fails, the rest is still carried out.
            with ExitStack() as waiting:
                for effect in reversed(effects):
                    waiting.callback(self._apply, effect)
        finally:
            if self.state.phase is Phase.ENDED:
                self.seen.shape.close()
                _current = None if _current is self else _current

    def tick(self) -> bool:
        """Follow object, settings and servo, and draw changes; True if the view changed.

        Raises
        ------
        PalpateError
            The press cannot go on.
        """
        thing = self._object_as_it_is()
        loop = self.loop
        if thing is None or loop is None:
            return True
        settings, problems = present_settings(
            thing, self.scene, self.homes, self.hands, self.home, loop.settings.devices
        )
        loop.follow(settings)
        self._problems += problems + lead_fingers(loop, self.leads, self.scene, self.hands)
        snapshot = self.as_seen(thing, loop.snapshot(), withdrawn=self.state.withdrawn)
        self.seen.drawn = self.drawn
        moved = self.snapshot is None or snapshot.tick != self.snapshot.tick
        self.snapshot = snapshot
        self._watch_faults(snapshot)
        self._report_problems(loop)
        if self.state.phase is not Phase.LOST and not self.state.withdrawn:
            young, touch = loop.settings.servo.young_modulus, loop.firming.pressing(snapshot)
            loop.firm(snapshot, self.seen.draw(thing, snapshot, young, touch))
        self._note_depths(loop.recorder, snapshot)
        return moved

    def switch_force(self) -> None:
        """Switch the device's force off at once, or on with a ramp."""
        now = time.monotonic()
        self.post(LetGo(now) if self.state.force_on else BringBack(now))

    def start_recording(self) -> None:
        """Start a recording.

        Raises
        ------
        PalpateError
            One is going on, or the servo refuses.
        """
        if self.loop is not None:
            record(self.loop, self.scene, 0.0 if self.snapshot is None else self.snapshot.time)

    @cached_property
    def seen(self) -> SeenBody:
        """Drawn body."""
        return SeenBody(self.drawn, self.tip, self.prop)

    @property
    def awaits_device(self) -> bool:
        """Whether a device leads whose first STATE has not come yet."""
        waiting = self.snapshot is not None and self.snapshot.state == "waiting"
        return self.state.phase is Phase.FEELING and waiting

    def _apply(self, effect: Effect) -> None:
        match effect:
            case Act.HANG_LIVE_LAYER:
                self._with_object(self._hang)
            case StartServo():
                self._start_loop()
            case SetDown() | Move() | SwitchForce():
                self._running.carry_out(effect)
                if isinstance(effect, SetDown) and not self.pinches:
                    self.seen.lift(self._running.snapshot().tick)
            case Act.DRAW_REST:
                self.seen.draw_rest(self.handle.find())
            case Act.STOP_SERVO:
                self._stop_loop()
            case Act.REMOVE_LIVE_LAYER:
                self._with_object(self._restore)
            case Act.KEEP_SHAPE:
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

    def _hang(self, thing: bpy.types.Object) -> None:
        if self.prop is not None:
            self.prop.make_ready(thing)
        live_layer.hang(thing)
        self.seen.drawn_contact = ()

    def _restore(self, thing: bpy.types.Object) -> None:
        live_layer.leave_edit_mode(thing)
        live_layer.remove(thing)
        if self.prop is not None:
            self.prop.give_back(thing)

    def _keep(self, thing: bpy.types.Object) -> None:
        self.kept_name, said = self.seen.keep(thing, self.scene, self.snapshot)
        self.kept = bool(self.kept_name) or self.prop is not None
        self.said += said

    def _start_loop(self) -> None:
        thing = self.handle.find()
        if thing is None:
            raise PalpateError("{name} is gone; choose another object", name=self.handle.name)
        if place_marks.hung(thing):
            bpy.context.view_layer.update()
        self.follow_frame(thing)
        scene, hands = self.scene, self.hands
        settings, _ = present_settings(thing, scene, self.homes, hands, self.home)
        self.loop = start_loop(
            thing, scene, self.drawn, settings, self.leads, hands, self.tip, self.prop
        )
        self._problems += lead_fingers(self.loop, self.leads, scene, hands)

    def _stop_loop(self) -> None:
        loop, self.loop = self.loop, None
        if loop is not None:
            loop.stop()

    def _object_as_it_is(self) -> bpy.types.Object | None:
        """The object, if the press can continue on it; else the press ends."""
        thing = self.handle.find()
        reason = reason_to_end(thing, self.drawn, withdrawn=self.state.withdrawn)
        if thing is not None and not reason and not self.follow_frame(thing):
            reason = "{name} was scaled; press Make Soft to bake it again"
        reasons = [Sentence(reason, name=(thing or self.handle).name), *self.others_that_end()]
        if any(reasons):
            self.post(GiveWay(next(filter(None, reasons))))
            return None
        return thing

    def _report_problems(self, loop: ForceLoop) -> None:
        """Report each problem once, when it begins."""
        shape = self.seen.shape
        found = (*self._problems, shape.problem, shape.notice)
        # Both fingers may have the same.
        texts = [text for text in dict.fromkeys(found) if text]
        self.said += [Say(text, warning=True) for text in texts if text not in self._reported]
        self._reported, self._problems = frozenset(texts), []

    def _note_depths(self, recorder: Recorder, snapshot: Snapshot) -> None:
        tool, mesh, moved = self.tip.tool, self.drawn.body.mesh, self.seen.displacements
        if tool is not None and recorder.going_on:
            depths = [finger_depth(mesh, tool, finger, moved) for finger in snapshot.fingers]
            recorder.note_depths(snapshot.time, depths)

    def _watch_faults(self, snapshot: Snapshot) -> None:
        if snapshot.fault:
            text = servo_words.fault_text(snapshot.fault)
            if snapshot.state == "stopped":
                # There is no recovery.
                self.post(GiveWay(text))
            elif text != self.state.message:
                self.post(Fault(text))
        elif self.state.phase is Phase.LOST:
            self.post(Moment.RECOVERED)


_current: PressSession | None = None


def current() -> PressSession | None:
    """Running press, if any."""
    return _current


def refusal() -> str:
    """Reason why something else cannot be done now: a press is running; empty if none is."""
    return "" if _current is None else live_layer.GOING_ON


def begin(
    thing: bpy.types.Object, scene: bpy.types.Scene, source: Source, *, pinch: bool = False
) -> PressSession:
    """Start to press an object; with ``pinch`` the pointer has two handles.

    Raises
    ------
    PalpateError
        A press is going on; the object or its body does not allow it; the device does not; the
        tool or the Empty chosen in the scene is missing.
    """
    global _current  # noqa: PLW0603  see PressSession.post
    if _current is not None:
        busy = _current.handle.name
        raise PalpateError("{name} is being pressed; end that first (Escape)", name=busy)
    leads = BOTH_POINTER if pinch else leads_of(scene, source)
    drawn = open_body(thing, scene)
    tip = chosen_tip(scene, thing, drawn.size)
    prop = PressedProp.begin(thing, drawn, tip.tool, bpy.context.selected_objects)
    drawn = drawn if prop is None else prop.drawn
    homes = homes_of(thing, scene, drawn.frame, leads)
    session = PressSession(ObjectHandle.of(thing), scene.name, drawn, homes, leads, prop, tip=tip)
    session.places = (None,) * len(leads)
    session.said += [Say(tip.remark, warning=True)] if tip.remark else []
    _current = session
    try:
        session.post(Start(source, device=any(lead.lead is Lead.DEVICE for lead in leads)))
    except BaseException:
        session.post(GiveWay(""))
        raise
    return session


def give_way(reason: str) -> None:
    """End the running press, if any, and restore the mesh."""
    if _current is not None:
        _current.post(GiveWay(reason))
