"""Grab, Twist and pull of an object that nobody holds: a hand holds it, and carries it about."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.contact.place import nearest_place
from ....core.contact.tool.pose import Pose
from ....core.errors import PalpateError
from ....core.grip.patch import Grip
from ....core.rest.grip import MOST_GRIPS
from ....core.rest.grip import Grip as Hold
from ...lying.coming_down import Alone
from ...lying.free_body import Lying
from ...object.drawn_body import DrawnBody
from .motion import Asked, Motion

Array = NDArray[np.float64]

SWINGS = "The object does not come to rest so; let it go nearer to what bears it"
SWALLOWS = "What bears the object is within it here; carry it round that, or let it go above"

# Share of a grip's radius at which it takes hold around its place.
AROUND = 0.7
# Times its size that an object is carried before it comes to rest on the way.
SIZES_TOGETHER = 4.0


@dataclass(frozen=True, eq=False)
class FreeHold:
    """Places of a body that a hand holds.

    Attributes
    ----------
    grips : what is held, each by some places.
    places : float64 (k, 3) of each, metres, body coordinates.
    starts : float64 (k, 3) of each, where they were as the hand took hold, in the world, metres.
    turn : float64 (3, 3), from the body's axes to the world's then.
    free : the body.
    """

    drawn: DrawnBody
    grips: tuple[Grip, ...]
    places: tuple[Array, ...]
    starts: tuple[Array, ...]
    turn: Array
    free: Alone
    springs_back = True
    restless, swallowed = SWINGS, SWALLOWS

    @classmethod
    def begin(
        cls, alone: Alone, rested: Lying, drawn: DrawnBody, grips: tuple[Grip, ...]
    ) -> FreeHold:
        """Take hold of a body that rests ``alone``.

        Raises
        ------
        PalpateError
            There are too many places.
        """
        if len(grips) > MOST_GRIPS:
            raise PalpateError(
                "{places} mirrored places are more than hands hold an object by that nothing pins; "
                "mirror across two axes at most",
                places=len(grips),
            )
        places = tuple(_around(drawn, grip, MOST_GRIPS // len(grips)) for grip in grips)
        starts = tuple(
            rested.rest.to_world(one + drawn.surface_displacements(rested.displacements, one))
            for one in places
        )
        holds = [
            (Hold(place), Pose.at(start))
            for place, start in zip(np.concatenate(places), np.concatenate(starts), strict=True)
        ]
        placement = rested.rest.placement
        free = Alone(alone.free.touched_by(holds, placement))
        return cls(drawn, grips, places, starts, placement.rotation, free)

    def lead(self, asked: Asked) -> Asked:
        """Have the hand move what it holds as asked."""
        mesh, shares = self.drawn.body.mesh, asked.shares(self.grips[0].normal)
        goals = [
            start + grip.fields(mesh, places) @ shares @ self.turn.T
            for grip, places, start in zip(self.grips, self.places, self.starts, strict=True)
        ]
        self.free.lead([Pose.at(goal) for goal in np.concatenate(goals)])
        return asked

    def parts(self, asked: Asked) -> int:
        """In how many parts it is carried, at most so far in each as it may go to come to rest."""
        way = abs(asked.amount) if asked.motion is Motion.PUSH else 0.0
        way += 0.0 if asked.by is None else float(np.linalg.norm(asked.by))
        return max(1, math.ceil(way / (SIZES_TOGETHER * self.drawn.size)))

    @property
    def wrench(self) -> tuple[Array, float]:
        """Force of the first grip on the body, newton, and its torque about its normal."""
        count, rest = len(self.places[0]), self.free.free.resting.rest
        forces = np.array([-touch.force for touch in rest.tools[:count]]) @ rest.placement.rotation
        arms = self.places[0] - self.grips[0].centre(self.drawn.body.mesh)
        torque = np.cross(arms, forces).sum(axis=0) @ self.grips[0].normal
        return forces.sum(axis=0), float(torque)


def _around(drawn: DrawnBody, grip: Grip, most: int) -> Array:
    """At ``most`` so many places of the surface (k, 3) by which a hand holds a grip."""
    centre = grip.centre(drawn.body.mesh)
    if most == 1:
        return centre[None]
    across = np.linalg.svd(grip.normal[None])[2][1:]
    count = most if most == 2 else most - 1
    angles = 2.0 * np.pi * np.arange(count) / count
    ring = np.column_stack([np.cos(angles), np.sin(angles)]) @ across
    asked = centre + AROUND * grip.radius * ring
    found = [nearest_place(drawn.body, one).position for one in asked]
    return np.array(found if most == 2 else [centre, *found])
