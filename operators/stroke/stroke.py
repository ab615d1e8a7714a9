"""Stroke on a body: what it does to the surface, and the force it takes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.grip.held_patch import HeldPatch
from ...core.grip.patch import Grip
from ..object.drawn_body import DrawnBody
from .motion import Asked, Motion
from .pushing import Pushing, Stroked


@dataclass(frozen=True, eq=False)
class Stroke:
    """Stroke at one place of a body and at its mirror images.

    A push is that of a fingertip, by the laws of contact: it only pushes. All else holds a patch
    of the surface (:mod:`...core.grip.held_patch`), and so does a push where no fingertip of this
    size gets to the place, as between two limbs: it would press what is beside it. Both are made
    when first asked for.

    Attributes
    ----------
    drawn : the body.
    grips : the place, then its mirror images.
    young_modulus, friction : of the object.
    """

    drawn: DrawnBody
    grips: tuple[Grip, ...]
    young_modulus: float
    friction: float

    def stroked(self, asked: Asked) -> Stroked:
        """What a motion does.

        Raises
        ------
        PalpateError
            The place is pinned; the fingertip is too small for the body; it goes no deeper.
        """
        # A pull begins at a depth of -0.
        inward = asked.motion is Motion.PUSH and math.copysign(1.0, asked.amount) > 0.0
        if inward and self._pushing.reaches:
            return self._pushing.to(asked, self.young_modulus)
        answer = self._held.answer(asked.shares(self.grips[0].normal), self.young_modulus)
        force = float(np.linalg.norm(answer.force))
        return Stroked(answer.displacements, force, answer.torque)

    @cached_property
    def _held(self) -> HeldPatch:
        drawn = self.drawn
        normals = drawn.node_normals[drawn.body.mesh.surface_nodes]
        return HeldPatch.of(drawn.body, self.grips, normals)

    @cached_property
    def _pushing(self) -> Pushing:
        return Pushing.begin(self.drawn, self.grips, self.friction, self.young_modulus)
