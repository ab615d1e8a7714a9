"""Result of one press without pointer, device or clock."""

from __future__ import annotations

from dataclasses import dataclass

from ...core.contact.touches import Touch
from ..scene.body_frame import Point


@dataclass(frozen=True, eq=False)
class PressedFinger:
    """Result of one finger; ``force`` (N, on the finger) in world axes, ``depth`` in metres."""

    made: Touch
    force: Point
    depth: float


@dataclass(frozen=True, eq=False)
class Pressed:
    """Result of a press; vectors in world axes, SI units. ``remarks`` report a changed tool and
    of files that could not be used or written.
    """

    fingers: tuple[PressedFinger, ...]
    largest_displacement: float
    layer: str
    remarks: tuple[str, ...] = ()

    @property
    def force(self) -> Point:
        """The first finger's, N."""
        return self.fingers[0].force
