"""What may happen to a press."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ..tool.tool_pose import Point, Turn


class Source(Enum):
    """Who moves the probe."""

    POINTER = "pointer"
    DEVICE = "device"
    EMPTY = "empty"


@dataclass(frozen=True)
class Start:
    """``device`` if a device leads any of the fingers."""

    source: Source
    device: bool = False


@dataclass(frozen=True)
class SetDown:
    """The pointer touches the surface here (body coordinates) with one of its fingers, whose tool
    is turned so.
    """

    point: Point
    finger: int = 0
    turn: Turn | None = None


@dataclass(frozen=True)
class Grab:
    """The pointer takes hold of a finger that was set down before; the finger stays where it is."""


@dataclass(frozen=True)
class Move:
    """The pointer wants the finger here (body coordinates)."""

    point: Point
    finger: int = 0


@dataclass(frozen=True)
class Release:
    """The pointer's button is up."""


@dataclass(frozen=True)
class Fault:
    """The device is gone, stale or in fault; ``text`` says which and what to do."""

    text: str


@dataclass(frozen=True)
class Recovered:
    """The device answers again."""


@dataclass(frozen=True)
class LetGo:
    """The user wants no force from the device, at once."""

    at: float


@dataclass(frozen=True)
class BringBack:
    """The user wants the device's force again."""

    at: float


@dataclass(frozen=True)
class SaveBegins:
    """Blender is about to write the file."""


@dataclass(frozen=True)
class SaveEnds:
    """Blender has written the file, or failed to."""


@dataclass(frozen=True)
class Keep:
    """The user wants the shape; ``dented`` if there is one, for the probe may be in the air."""

    dented: bool = True


@dataclass(frozen=True)
class Cancel:
    """The user wants back what was there."""


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
