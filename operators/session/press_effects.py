"""Effects of a press on servo, mesh and user."""

from __future__ import annotations

from dataclasses import dataclass

from ..tool.tool_turn import Point, Turn
from .press_events import Source


@dataclass(frozen=True)
class StartServo:
    source: Source


@dataclass(frozen=True)
class PlaceProbe:
    """Lift the probe off and set it down there, without a sweep through the body."""

    point: Point
    finger: int = 0
    turn: Turn | None = None


@dataclass(frozen=True)
class MoveProbe:
    point: Point
    finger: int = 0


@dataclass(frozen=True)
class SwitchForce:
    """Switch the force off with the next tick, or on with a ramp."""

    on: bool


@dataclass(frozen=True)
class StopServo:
    """Stop the servo: zero force, thread joined."""


@dataclass(frozen=True)
class HangLiveShape:
    """Add the live shape key."""


@dataclass(frozen=True)
class DrawRest:
    """Write the rest shape into the live shape key."""


@dataclass(frozen=True)
class RemoveLiveShape:
    """Restore the mesh as it was found, bit for bit."""


@dataclass(frozen=True)
class KeepShape:
    """Turn the live shape key into a kept one."""


@dataclass(frozen=True)
class Say:
    """Report to the user."""

    text: str
    warning: bool = False


Effect = (
    StartServo
    | PlaceProbe
    | MoveProbe
    | SwitchForce
    | StopServo
    | HangLiveShape
    | DrawRest
    | RemoveLiveShape
    | KeepShape
    | Say
)
