"""Fingertips of a push: where they are set down on a body at rest, and where they go."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.contact.tool.pose import Pose, facing, resting_on
from ....core.contact.tool.tool_surface import surface_and_correction
from ....core.contact.tool.tools import Tool, sphere
from ....core.errors import PalpateError
from ....core.grip.patch import Grip
from ....core.rest.bearing_points import pressing_points
from ...object.drawn_body import DrawnBody
from .grips import grip_at
from .motion import Asked

Array = NDArray[np.float64]

# Radii by which what is beside it may keep a fingertip off its place. Held off by more, as between
# a wing and the flank, it wedges what is beside it apart, and its own place goes aside.
FARTHEST_OFF = 0.1
# Shares of the size asked for that are tried where it does not get to its place.
SMALLER = (1.0, 0.5, 0.25)


@dataclass(frozen=True, eq=False)
class Fingertips:
    """Fingertips over their places.

    Attributes
    ----------
    drawn : the body.
    grips : the places.
    tool : the fingertip.
    samples : float64 (n, 3), places that it may touch.
    """

    drawn: DrawnBody
    grips: tuple[Grip, ...]
    tool: Tool
    samples: Array

    @classmethod
    def over(cls, drawn: DrawnBody, grips: tuple[Grip, ...], share: float = 1.0) -> Fingertips:
        """Fingertips as large as grips, or a ``share`` of that.

        Raises
        ------
        PalpateError
            They are too small for the body.
        """
        tool, body = sphere(share * grips[0].radius), drawn.body
        touched = pressing_points if body.is_free else surface_and_correction
        return cls(drawn, grips, tool, touched(body, tool)[0].positions)

    @classmethod
    def fitting(cls, drawn: DrawnBody, grips: tuple[Grip, ...]) -> Fingertips:
        """Fingertips as large as grips, or smaller where what is beside would hold those off.

        Raises
        ------
        PalpateError
            None gets there.
        """
        for share in SMALLER:
            found = cls.over(drawn, grips, share)
            if found.reach:
                return found
        raise PalpateError("No fingertip gets to this place; push beside it, or choose other Pins")

    @property
    def reach(self) -> bool:
        """Whether a fingertip gets to its place without being held off by what is beside it."""
        grip = self.grips[0]
        off = self.set_down(grip).position - grip.centre(self.drawn.body.mesh)
        farthest = (1.0 + FARTHEST_OFF) * self.tool.radius
        return float(np.linalg.norm(off)) <= farthest

    def places(self, asked: Asked) -> list[Grip]:
        """Places along the surface, over which fingertips then go in."""
        return [self._beside(grip, asked) for grip in self.grips]

    def pose(self, grip: Grip, depth: float) -> Pose:
        """Where a fingertip is that has gone in by a depth, metres."""
        return self.set_down(grip).moved(-depth * grip.normal)

    def set_down(self, grip: Grip) -> Pose:
        """Where a fingertip just touches a place."""
        turn = facing(grip.normal, np.eye(3)[0])
        centre = grip.centre(self.drawn.body.mesh)
        return resting_on(self.tool, turn, centre, grip.normal, self.samples)

    def _beside(self, grip: Grip, asked: Asked) -> Grip:
        if asked.by is None or not asked.by.any():
            return grip
        beside = grip.centre(self.drawn.body.mesh) + grip.mirror @ asked.by
        return grip_at(self.drawn, beside, grip.radius, grip.mirror)
