"""Stroke on a body: what it does to the surface, and the force it takes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import bpy
import numpy as np

from ....core.errors import PalpateError
from ....core.grip.held_patch import HeldPatch
from ....core.grip.patch import Grip
from ....core.shape.felt import held_loads
from ....core.shape.found_behind import FoundBehind
from ...object.drawn_body import DrawnBody
from .deepest import Deepest
from .motion import Asked, Motion
from .pushing import Pushing
from .stroked import Stroked
from .thickness import Thickness

# The limit of a push is reached to within a few percent, in some steps; where a part gives way as a
# whole, each goes on as far as the one before tells.
ALMOST, LEAST_GONE = 0.97, 0.05
MOST_STEPS = 6
# Seconds between pictures.
PACE = 1.0 / 30.0


@dataclass(frozen=True, eq=False)
class Stroke:
    """Stroke at one place of a body and at its mirror images, where it lies.

    A push is that of a fingertip, by the laws of contact: it only pushes. All else holds a patch
    of the surface (:mod:`....core.grip.held_patch`), and so does a push where no fingertip of this
    size gets to the place, as between two limbs: it would press what is beside it; or where it
    would slip past a thin part, as an ear, that bends out of its way. Both are made when first
    asked for.

    Attributes
    ----------
    drawn : the body.
    grips : the place, then its mirror images.
    young_modulus, friction : of the object.
    behind : its shape, where that is no linear one.
    is_held : whether what does not balance is held by pins or a hand; else a patch is drawn
        together or apart by forces that do.
    """

    drawn: DrawnBody
    grips: tuple[Grip, ...]
    young_modulus: float
    friction: float
    behind: FoundBehind | None = None
    is_held: bool = True

    @property
    def pace(self) -> float:
        """Seconds between pictures while the pointer stays; 0 where nothing moves then."""
        return 0.0 if self.behind is None else PACE

    @property
    def moves(self) -> bool:
        """Whether there is more to draw though the pointer stays."""
        return self.behind is not None and self.behind.news

    def stroked(self, asked: Asked) -> tuple[Asked, Stroked]:
        """What a motion does, by the object's shape, waiting for that; and what was done of it,
        where it asked to go deeper than it can, with the reason.

        Raises
        ------
        PalpateError
            The place is pinned; the fingertip is too small for the body; it goes no deeper.
        """
        return self.ended(*self._linear(asked))

    def towards(self, asked: Asked) -> tuple[Asked, Stroked]:
        """The same while the pointer moves: as far as the shape is known."""
        done, linear = self._linear(asked)
        if self.behind is None:
            return done, linear
        return done, linear.shaped(self.behind.now(linear.loads))

    def ended(self, asked: Asked, stroked: Stroked) -> tuple[Asked, Stroked]:
        """What came of the stroke once all is at rest."""
        if self.behind is None or asked.nothing:
            return asked, stroked
        return asked, stroked.shaped(self.behind.at_rest(stroked.loads))

    def _linear(self, asked: Asked) -> tuple[Asked, Stroked]:
        # A pull begins at a depth of -0.
        inward = asked.motion is Motion.PUSH and math.copysign(1.0, asked.amount) > 0.0
        thickness = self._thickness
        if not inward or thickness is None:
            return asked, self._done(asked, inward=inward)
        # From below: what has been pushed through itself does not come back as it was.
        deepest = self._deepest(thickness)
        most, ends = deepest.metres, deepest.reason
        done = replace(asked, amount=min(asked.amount, most))
        stroked = self._done(done, inward=True)
        for _ in range(MOST_STEPS - 1):
            moved = self.drawn.node_displacements(stroked.displacements)
            share = thickness.gone(done.amount, moved) / most
            if done.amount == asked.amount or share >= ALMOST:
                break
            amount = min(asked.amount, done.amount / max(share, LEAST_GONE))
            try:
                farther = self._done(replace(asked, amount=amount), inward=True)
            except PalpateError as problem:
                # As far as it went.
                ends = problem.sentence
                break
            done, stroked = replace(asked, amount=amount), farther
        if done.amount == asked.amount:
            return asked, stroked
        return done, replace(stroked, ends=ends)

    def make_ready(self, thing: bpy.types.Object) -> None:
        """Nothing moves an object that is pinned."""

    def leave(self, thing: bpy.types.Object, stroked: Stroked) -> None:
        """Nothing leaves it elsewhere."""

    def follow(self, stroked: Stroked) -> None:
        """Nothing else moves."""

    def give_back(self, thing: bpy.types.Object) -> None:
        """Nothing has moved it."""

    def close(self) -> None:
        """End what goes on in the background."""
        if self.behind is not None:
            self.behind.close()

    def _done(self, asked: Asked, *, inward: bool) -> Stroked:
        if inward and self._pushing.reaches:
            pushed = self._pushing.to(asked, self.young_modulus)
            if not self._pushing.slips(asked, pushed):
                return pushed
        answer = self._held.answer(asked.shares(self.grips[0].normal), self.young_modulus)
        force = float(np.linalg.norm(answer.force))
        if asked.motion is Motion.PINCH:
            # What draws together is balanced: half of it goes one way.
            force = 0.5 * float(np.linalg.norm(answer.forces, axis=1).sum()) / len(self.grips)
        loads = held_loads(self.drawn.body, answer.nodes, answer.forces, is_held=self.is_held)
        return Stroked(answer.displacements, force, answer.torque, loads=tuple(loads))

    def _deepest(self, thickness: Thickness) -> Deepest:
        return Deepest.of(thickness, self._pushing.fingertips)

    @cached_property
    def _thickness(self) -> Thickness | None:
        return Thickness.under(self.drawn, self.grips[0])

    @cached_property
    def _held(self) -> HeldPatch:
        drawn = self.drawn
        normals = drawn.node_normals[drawn.body.mesh.surface_nodes]
        return HeldPatch.of(drawn.body, self.grips, normals, is_held=self.is_held)

    @cached_property
    def _pushing(self) -> Pushing:
        return Pushing.begin(self.drawn, self.grips, self.friction, self.young_modulus)
