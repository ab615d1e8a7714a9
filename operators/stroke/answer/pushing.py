"""Push of a stroke: fingertips on a body, by the laws of contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....core.contact.press import ContactSettings, Press
from ....core.contact.touches import ToolTouch
from ....core.contact.unsettled import NotANumberError, UnsettledError
from ....core.errors import PalpateError
from ....core.grip.patch import Grip
from ....core.shape.felt import loads_of
from ...object.drawn_body import DrawnBody
from .deepest import NO_NUMBER, NO_REST
from .fingertips import Fingertips
from .motion import Asked
from .stroked import Stroked

# It has slipped where its place goes less of its way than the first share, and its force leans
# aside by more than 45 degrees, or where the place hardly goes at all. Either alone may be: a place
# goes half the way where triangles are as large as the fingertip, and a limb that bends turns its
# side to it.
LEAST_ALONG, HARDLY_ALONG, LEAST_STRAIGHT = 0.35, 0.1, 0.7


@dataclass(frozen=True, eq=False)
class Pushing:
    """Fingertips set down at their places, and the press of all of them."""

    fingertips: Fingertips
    press: Press

    @classmethod
    def begin(
        cls, drawn: DrawnBody, grips: tuple[Grip, ...], friction: float, young_modulus: float
    ) -> Pushing:
        """Set fingertips down.

        Raises
        ------
        PalpateError
            They are too small for the body.
        """
        fingertips = Fingertips.over(drawn, grips)
        settings = ContactSettings(young_modulus, friction)
        press = Press(drawn.body, [fingertips.tool] * len(grips), settings)
        begun = cls(fingertips, press)
        if begun.reaches:
            press.to([fingertips.set_down(grip) for grip in grips])
        return begun

    @property
    def reaches(self) -> bool:
        """Whether a fingertip gets to its place without being held off by what is beside it."""
        return self.fingertips.reach

    def slips(self, asked: Asked, pushed: Stroked) -> bool:
        """Whether the first fingertip has gone past its place, which bends or leans out of its way,
        instead of taking it along; one that is led along the surface may.
        """
        if not asked.amount or (asked.by is not None and asked.by.any()):
            return False
        tips, (touch, *_) = self.fingertips, pushed.touches
        grip = tips.grips[0]
        centre = grip.centre(self.press.body.mesh)
        (moved,) = tips.drawn.surface_displacements(pushed.displacements, centre[None])
        along = -float(moved @ grip.normal) / asked.amount
        straight = abs(float(touch.force @ grip.normal))
        leans = straight < LEAST_STRAIGHT * float(np.linalg.norm(touch.force))
        return along < (LEAST_ALONG if leans else HARDLY_ALONG)

    def to(self, asked: Asked, young_modulus: float) -> Stroked:
        """What fingertips do that have gone in and, with the surface, sideways.

        Raises
        ------
        PalpateError
            There is no rest so deep; forces are no numbers there.
        """
        tips = self.fingertips
        try:
            touches = self.press.to([tips.pose(grip, asked.amount) for grip in tips.places(asked)])
        except UnsettledError as problem:
            raise PalpateError(NO_REST) from problem
        except NotANumberError as problem:
            raise PalpateError(NO_NUMBER) from problem
        made = [touch for touch in touches if isinstance(touch, ToolTouch)]
        nodes = np.concatenate([touch.nodes for touch in made])
        forces = np.concatenate([touch.nodal_forces for touch in made])
        return Stroked(
            self.press.body.deform(nodes, forces, young_modulus),
            float(np.linalg.norm(made[0].force)),
            touches=tuple(made),
            loads=tuple(loads_of(made)),
        )
