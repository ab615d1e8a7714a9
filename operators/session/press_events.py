"""Events of a press."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ..tool.tool_turn import Point, Turn


class Source(Enum):
    """Kind of thing that moves the probe."""

    POINTER = "pointer"
    DEVICE = "device"
    EMPTY = "empty"


@dataclass(frozen=True)
class Start:
    """Start of the press; ``device`` if a device leads any finger."""

    source: Source
    device: bool = False


@dataclass(frozen=True)
class SetDown:
    """The pointer sets one of its fingers down here (body coordinates), with this rotation of its
    tool; it is lifted off first, so that it does not sweep through the body.
    """

    point: Point
    finger: int = 0
    turn: Turn | None = None


@dataclass(frozen=True)
class Move:
    """The pointer moves the finger here (body coordinates)."""

    point: Point
    finger: int = 0


@dataclass(frozen=True)
class Fault:
    """The device is gone, stale or in fault; ``text`` has the reason and the remedy."""

    text: str


@dataclass(frozen=True)
class LetGo:
    """The user switches the device's force off, at once."""

    at: float


@dataclass(frozen=True)
class BringBack:
    """The user switches the device's force on again."""

    at: float


@dataclass(frozen=True)
class Keep:
    """The user keeps the shape; ``dented`` unless the probe is in the air."""

    dented: bool = True


@dataclass(frozen=True)
class GiveWay:
    """Something else needs the object: file load, undo, deletion, edit, unregister, exit."""

    reason: str


class Moment(Enum):
    """Event that needs no more words."""

    GRAB = "the pointer grabs a finger that was set down before; it does not move"
    RELEASE = "the pointer's button is released"
    RECOVERED = "the device answers again"
    SAVE_BEGINS = "the file is about to be written"
    SAVE_ENDS = "the file was written, or could not be"
    CANCEL = "the user cancels the press"


Event = Start | SetDown | Move | Fault | LetGo | BringBack | Keep | GiveWay | Moment
