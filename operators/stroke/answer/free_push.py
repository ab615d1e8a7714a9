"""Push on an object that nobody holds: fingertips that go in, before which it gives way."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ....core.contact.tool.pose import AIR, Pose
from ....core.grip.patch import Grip
from ....core.rest.rest import Rest
from ...lying.coming_down import ROLLS, Alone
from ...lying.free_body import Lying
from ...lying.free_pile import FreePile
from ...object.drawn_body import DrawnBody
from .deepest import DEEPEST, Deepest
from .fingertips import Fingertips
from .motion import Asked
from .thickness import Thickness

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FreePush:
    """Fingertips over a body that came to rest, and the body among them."""

    tips: Fingertips
    rested: Lying
    free: Alone | FreePile
    springs_back = False
    restless, swallowed = ROLLS, DEEPEST

    @classmethod
    def begin(
        cls, alone: Alone | FreePile, rested: Lying, drawn: DrawnBody, grips: tuple[Grip, ...]
    ) -> FreePush:
        """Set fingertips down on a body that rests ``alone``.

        Raises
        ------
        PalpateError
            They do not fit, or it does not come to rest.
        """
        tips = Fingertips.fitting(drawn, grips)
        off = 2.0 * float(np.linalg.norm(rested.displacements, axis=1).max()) + AIR * drawn.size
        starts = [(tips.tool, rested.in_world(tips.pose(grip, -off))) for grip in grips]
        free = alone.touched_by(starts)
        free.take_in_hand()
        free.settle()
        return cls(tips, rested, free)

    @property
    def deepest(self) -> Deepest | None:
        """How deep the fingertips go at most, where the body is now: it is pressed in so far beside
        what it has given way as a whole. None where no far side is found.
        """
        thickness = self._thickness
        if thickness is None:
            return None
        limit = Deepest.of(thickness, self.tips)
        gone = self._far(thickness, self.free.rest) - self._far(thickness, self.rested.rest)
        inward = self.rested.rest.placement.rotation @ thickness.inward
        return replace(limit, metres=limit.metres + max(0.0, float(gone @ inward)))

    def lead(self, asked: Asked) -> Asked:
        """Have the fingertips go in as asked; what is asked of them at most."""
        deepest, done = self.deepest, asked
        if deepest is not None and asked.amount > deepest.metres:
            done = replace(asked, amount=deepest.metres)
        self.free.lead([self._goal(grip, done.amount) for grip in self.tips.places(done)])
        return done

    def parts(self, _asked: Asked) -> int:
        """In how many parts it goes in: a fingertip takes its time by itself."""
        return 1

    @property
    def wrench(self) -> tuple[Array, float]:
        """Force of the first fingertip on the body, newton, and its torque about its normal."""
        return -self.free.touches()[0].force, 0.0

    @cached_property
    def _thickness(self) -> Thickness | None:
        return Thickness.under(self.tips.drawn, self.tips.grips[0])

    def _far(self, thickness: Thickness, rest: Rest) -> Array:
        """Place (3,) of the far side where the body rests so, in the world, metres."""
        drawn = self.tips.drawn
        displacements = rest.displacements()
        nodes = drawn.body.mesh.nodes + drawn.node_displacements(displacements)
        return rest.to_world(thickness.alpha @ nodes[thickness.nodes])

    def _goal(self, grip: Grip, depth: float) -> Pose:
        """Pose in the world of a fingertip that has gone in from where the surface came to rest."""
        drawn = self.tips.drawn
        centre = grip.centre(drawn.body.mesh)
        (sagged,) = drawn.surface_displacements(self.rested.displacements, centre[None])
        return self.rested.in_world(self.tips.pose(grip, depth).moved(sagged))
