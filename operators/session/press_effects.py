"""Effects of a press on servo, mesh and user."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from .press_events import Move, SetDown, Source


@dataclass(frozen=True)
class StartServo:
    source: Source


@dataclass(frozen=True)
class SwitchForce:
    """Switch the force off with the next tick, or on with a ramp."""

    on: bool


@dataclass(frozen=True)
class Say:
    """Report to the user."""

    text: str
    warning: bool = False


class Act(Enum):
    """Effect that needs no more words."""

    STOP_SERVO = "stop the servo: zero force, thread joined"
    HANG_LIVE_LAYER = "add the live layer"
    DRAW_REST = "write no displacement into the live layer"
    REMOVE_LIVE_LAYER = "restore the mesh as it was found, bit for bit"
    KEEP_SHAPE = "turn the live layer into a kept one"


# What the pointer does with a finger is carried out as it is told.
Effect = StartServo | SetDown | Move | SwitchForce | Say | Act
