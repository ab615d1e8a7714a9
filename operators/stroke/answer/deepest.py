"""How far a push goes in at most, and what is said there."""

from __future__ import annotations

from dataclasses import dataclass

from ...tool.finger_tip import FingerTip
from .fingertips import Fingertips
from .thickness import Thickness

# Share of its thickness by which a push squeezes a body at most: beyond, it would come out on the
# far side.
MOST_SQUEEZED = 0.8
# The same above what is pinned, which gives way nowhere: beyond, Real finds no shape in some places
# of a figure, and the surface leaves the fingertip.
MOST_ABOVE_PINNED = 0.65
DEEPEST = "This is as deep as the fingertip goes here; a larger one goes deeper (F)"
ENDS = "The body ends here: it goes no deeper"
PINNED = "What is pinned is near beneath: it goes no deeper"
# Where nothing limits it, and yet there is no answer farther in.
NO_REST = "The fingertip finds no rest any deeper here; try a larger one (F)"
NO_NUMBER = "No force can be computed any deeper here; try a larger fingertip (F)"


@dataclass(frozen=True)
class Deepest:
    """Limit of a push: ``metres`` by which the surface is pressed in at most, beside what the body
    gives way as a whole, and the ``reason``.
    """

    metres: float
    reason: str

    @classmethod
    def of(cls, thickness: Thickness, fingertips: Fingertips) -> Deepest:
        """Limit at a place: that of the far side or of what is pinned, or a fingertip's if that is
        nearer, for a linear body lets go of what it has swallowed, and leans aside.
        """
        share, reason = (MOST_ABOVE_PINNED, PINNED) if thickness.pinned else (MOST_SQUEEZED, ENDS)
        far = cls(share * thickness.metres, reason)
        if not fingertips.reach:
            return far
        tip = cls(FingerTip(fingertips.tool).deepest, DEEPEST)
        return min(far, tip, key=lambda one: one.metres)
