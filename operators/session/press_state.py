"""State machine of a press, a pure function: ``transition(state, event) -> (state, effects)``.

No Blender, no device, no clock: the session (:mod:`press_session`) makes the events and carries out
the effects, in order.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum

from .press_effects import Act, Effect, Say, StartServo, SwitchForce
from .press_events import (
    BringBack,
    Event,
    Fault,
    GiveWay,
    Keep,
    LetGo,
    Moment,
    Move,
    SetDown,
    Source,
    Start,
)

# Two strokes of the key within this time are an alarm: the force stays off.
CALM_SECONDS = 0.6


class Phase(Enum):
    """Phase of a press."""

    IDLE = "idle"
    READY = "ready"  # pointer: nothing touched yet
    DRAGGING = "dragging"  # pointer: button held, probe follows
    HOLDING = "holding"  # pointer: button released, probe stays
    FEELING = "feeling"  # device or Empty moves the probe
    LOST = "lost"  # the device went away or reports a fault
    ENDED = "ended"


@dataclass(frozen=True)
class PressState:
    """State of a press; ``withdrawn`` while the file is being written."""

    phase: Phase = Phase.IDLE
    source: Source = Source.POINTER
    has_device: bool = False
    withdrawn: bool = False
    message: str = ""
    # Whether the user wants the device's force, and when it was last switched off (s, any clock).
    force_on: bool = True
    let_go_at: float = -math.inf

    @property
    def active(self) -> bool:
        """Whether the press has started and not ended."""
        return self.phase not in (Phase.IDLE, Phase.ENDED)

    @property
    def pressed(self) -> bool:
        """Whether there is a shape to keep."""
        return self.phase in (Phase.DRAGGING, Phase.HOLDING, Phase.FEELING)


Step = tuple[PressState, tuple[Effect, ...]]


def transition(state: PressState, event: Event) -> Step:
    """State after ``event``, and effects in order. Events that do not fit change nothing."""
    if isinstance(event, Start):
        return _start(state, event)
    if not state.active:
        return state, ()
    match event:
        case GiveWay(reason):
            return _end(state, reason)
        case Moment.CANCEL:
            return _end(state, "")
        case Keep(dented):
            return _keep(state, dented=dented)
        case Moment.SAVE_BEGINS | Moment.SAVE_ENDS:
            return _save(state, event)
        case Fault() | Moment.RECOVERED if state.source is Source.DEVICE:
            return _device(state, event)
        case LetGo() | BringBack() if state.has_device:
            return _switch_force(state, event)
        case SetDown() | Moment.GRAB | Move() | Moment.RELEASE if state.source is Source.POINTER:
            return _pointer(state, event)
    return state, ()


def _start(state: PressState, event: Start) -> Step:
    if state.phase is not Phase.IDLE:
        return state, ()
    phase = Phase.READY if event.source is Source.POINTER else Phase.FEELING
    has_device = event.device or event.source is Source.DEVICE
    begun = PressState(phase, event.source, has_device=has_device)
    return begun, (Act.HANG_LIVE_LAYER, StartServo(event.source))


def _pointer(state: PressState, event: SetDown | Move | Moment) -> Step:
    match state.phase, event:
        case ((Phase.READY | Phase.HOLDING), SetDown()):
            return replace(state, phase=Phase.DRAGGING, message=""), (event,)
        case ((Phase.READY | Phase.HOLDING), Moment.GRAB):
            return replace(state, phase=Phase.DRAGGING, message=""), ()
        case Phase.DRAGGING, Move():
            return state, (event,)
        case Phase.DRAGGING, Moment.RELEASE:
            return replace(state, phase=Phase.HOLDING), ()
    return state, ()


def _device(state: PressState, event: Fault | Moment) -> Step:
    match state.phase, event:
        case Phase.FEELING, Fault(text):
            lost = replace(state, phase=Phase.LOST, message=text)
            return lost, (() if state.withdrawn else (Act.DRAW_REST,)) + (Say(text, warning=True),)
        case Phase.LOST, Fault(text):
            return replace(state, message=text), ()
        case Phase.LOST, Moment.RECOVERED:
            text = "The device is back"
            return replace(state, phase=Phase.FEELING, message=""), (Say(text),)
    return state, ()


def _switch_force(state: PressState, event: LetGo | BringBack) -> Step:
    match event:
        case LetGo(at):
            # Also when it is off already, for safety.
            return replace(state, force_on=False, let_go_at=at), (SwitchForce(on=False),)
        case BringBack(at) if not state.force_on and at - state.let_go_at >= CALM_SECONDS:
            return replace(state, force_on=True), (SwitchForce(on=True),)
    return state, ()


def _save(state: PressState, event: Moment) -> Step:
    begins = event is Moment.SAVE_BEGINS
    if state.withdrawn == begins:
        return state, ()
    effect = Act.REMOVE_LIVE_LAYER if begins else Act.HANG_LIVE_LAYER
    return replace(state, withdrawn=begins), (effect,)


def _keep(state: PressState, *, dented: bool) -> Step:
    if state.withdrawn or not (state.pressed and dented):
        text = "There is no shape to keep: nothing is pressed, or all of it springs back"
        return replace(state, message=text), (Say(text),)
    return replace(state, phase=Phase.ENDED, message=""), (Act.STOP_SERVO, Act.KEEP_SHAPE)


def _end(state: PressState, reason: str) -> Step:
    effects: tuple[Effect, ...] = (Act.STOP_SERVO,)
    if not state.withdrawn:
        effects += (Act.REMOVE_LIVE_LAYER,)
    if reason:
        effects += (Say(reason, warning=True),)
    return replace(state, phase=Phase.ENDED, withdrawn=False, message=reason), effects
