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
    tool.
    """

    point: Point
    finger: int = 0
    turn: Turn | None = None


@dataclass(frozen=True)
class Grab:
    """The pointer grabs a finger that was set down before; it does not move."""


@dataclass(frozen=True)
class Move:
    """The pointer moves the finger here (body coordinates)."""

    point: Point
    finger: int = 0


@dataclass(frozen=True)
class Release:
    """The pointer's button is released."""


@dataclass(frozen=True)
class Fault:
    """The device is gone, stale or in fault; ``text`` has the reason and the remedy."""

    text: str


@dataclass(frozen=True)
class Recovered:
    """The device answers again."""


@dataclass(frozen=True)
class LetGo:
    """The user switches the device's force off, at once."""

    at: float


@dataclass(frozen=True)
class BringBack:
    """The user switches the device's force on again."""

    at: float


@dataclass(frozen=True)
class SaveBegins:
    """Blender is about to write the file."""


@dataclass(frozen=True)
class SaveEnds:
    """Blender has written the file, or failed to."""


@dataclass(frozen=True)
class Keep:
    """The user keeps the shape; ``dented`` unless the probe is in the air."""

    dented: bool = True


@dataclass(frozen=True)
class Cancel:
    """The user cancels the press."""


@dataclass(frozen=True)
class GiveWay:
    """Something else needs the object: file load, undo, deletion, edit, unregister, exit."""

    reason: str


Event = (
    Start
    | SetDown
    | Grab
    | Move
    | Release
    | Fault
    | Recovered
    | LetGo
    | BringBack
    | SaveBegins
    | SaveEnds
    | Keep
    | Cancel
    | GiveWay
)
