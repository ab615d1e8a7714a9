"""Strokes on an object that nobody holds: it gives way, is carried, and comes to rest."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import bpy
import numpy as np
from numpy.typing import NDArray

from ....core.errors import PalpateError
from ....core.grip.held_patch import HeldPatch
from ....core.grip.patch import Grip
from ...lying.before import Before
from ...lying.coming_down import refuse_played, show
from ...lying.free_body import FreeBody, Lying, lie, supports_under
from ...object.drawn_body import DrawnBody
from ...shape.drawn_shape import found_behind
from .deepest import ENDS
from .free_hold import FreeHold
from .free_push import FreePush
from .motion import Asked, Motion
from .stroke import ALMOST, PACE, Stroke
from .stroked import Stroked

Array = NDArray[np.float64]

# From picture to picture a body goes on by so many ticks, of so many seconds.
TICKS, TICK = 20, 4e-3


@dataclass(frozen=True, eq=False)
class FreeStroke:
    """Stroke on an object that nobody holds; made by :meth:`begin`, which moves nothing.

    A push is that of fingertips, and a pinch draws the surface together: both stay as a layer.
    Grab, Twist and pull take hold of the object and carry it; let go, it springs back and comes
    down to rest.

    Attributes
    ----------
    drawn : the body where it came to rest before.
    grips : the place, then its mirror images.
    young_modulus : of the object.
    rested : the body there.
    """

    drawn: DrawnBody
    grips: tuple[Grip, ...]
    young_modulus: float
    rested: Lying
    _before: Before
    _alone: FreeBody
    pace, moves = PACE, True

    @classmethod
    def begin(
        cls, thing: bpy.types.Object, drawn: DrawnBody, grips: tuple[Grip, ...]
    ) -> FreeStroke:
        """Let the body come to rest.

        Raises
        ------
        PalpateError
            It does not, or cannot move by itself.
        """
        refuse_played(thing)
        graph = bpy.context.evaluated_depsgraph_get()
        alone = lie(thing, drawn, supports_under(thing, drawn, graph))
        rested = alone.come_down()
        drawn = replace(drawn, frame=rested.frame)
        young_modulus = thing.palpate.young_modulus
        return cls(drawn, grips, young_modulus, rested, Before.of(thing), alone)

    @property
    def ends(self) -> str:
        """Why a push goes no deeper."""
        deepest = self._push.deepest
        return ENDS if deepest is None else deepest.reason

    def make_ready(self, thing: bpy.types.Object) -> None:
        """Move the object to where it came to rest."""
        self.leave(thing, self.rested)

    def leave(self, thing: bpy.types.Object, lying: Lying) -> None:
        """Have the object lie there."""
        show([thing], [lying], self._alone.supports.floor)

    def give_back(self, thing: bpy.types.Object) -> None:
        """Have the object as it was before."""
        self._before.give_back(thing)

    def close(self) -> None:
        """Nothing goes on in the background."""

    def stroked(self, asked: Asked) -> tuple[Asked, Stroked]:
        """Where the body comes to rest under hands that go where they are asked to; and what was
        done of it, where it asked to go deeper than the body is thick.

        Raises
        ------
        PalpateError
            They do not fit, or the body does not come to rest.
        """
        hand = self._hand(asked)
        if hand is None:
            return asked, self._pinched(asked)
        try:
            for part in range(1, parts := hand.parts(asked)):
                self._led(hand, asked.part(part / parts))
                hand.free.settle()
            done, lying = self._led(hand, asked), hand.free.settle()
            # What gives way as a whole is pushed on, as far as it has given way.
            gone = 0.0
            while done is not asked and ALMOST * done.amount > gone:
                gone = done.amount
                done, lying = self._led(hand, asked), hand.free.settle()
        except PalpateError as problem:
            raise PalpateError(hand.refused) from problem
        return done, _stroked(hand, lying)

    def towards(self, asked: Asked) -> tuple[Asked, Stroked]:
        """The same on the way there, as far as the body goes while a picture is drawn."""
        hand = self._hand(asked)
        if hand is None:
            return asked, self._pinched(asked)
        done = self._led(hand, asked)
        for _ in range(TICKS):
            hand.free.resting.tick(TICK, hurried=True)
        return done, _stroked(hand, hand.free.now())

    def ended(self, asked: Asked, stroked: Stroked) -> tuple[Asked, Stroked]:
        """What came of the stroke once all is at rest; of a push as far as it went, where it never
        is. What was held comes down.

        Raises
        ------
        PalpateError
            Nothing bears it where it was let go.
        """
        if stroked.springs_back and stroked.lying is not None:
            let_go = self._alone.touched_by((), stroked.lying.rest.placement)
            try:
                return asked, replace(stroked, lying=let_go.come_down(), touches=())
            except PalpateError as problem:
                raise PalpateError(
                    "The object does not come to rest where it was let go, and was given back: let "
                    "go above its floor or a collider"
                ) from problem
        try:
            return self.stroked(asked)
        except PalpateError:
            return asked, stroked

    def _led(self, hand: FreePush | FreeHold, asked: Asked) -> Asked:
        """Lead a hand; what is asked of it at most."""
        # Asked in the axes of the body as it was touched, which may have turned as it came to rest.
        turn = self.rested.rest.placement.rotation.T @ self._alone.drawn.frame.rotation
        by = None if asked.by is None else turn @ asked.by
        amount = hand.lead(replace(asked, by=by)).amount
        return asked if amount == asked.amount else replace(asked, amount=amount)

    def _hand(self, asked: Asked) -> FreePush | FreeHold | None:
        """What moves the body; none where the motion only bends it."""
        match asked.motion:
            case Motion.PINCH:
                return None
            # A pull begins at a depth of -0.
            case Motion.PUSH if math.copysign(1.0, asked.amount) > 0.0:
                return self._push
        return self._hold

    def _pinched(self, asked: Asked) -> Stroked:
        answer = self._patch.answer(asked.shares(self.grips[0].normal), self.young_modulus)
        lying = self._alone.now(answer.displacements)
        # What draws together is balanced: half of it goes one way.
        force = 0.5 * float(np.linalg.norm(answer.forces, axis=1).sum()) / len(self.grips)
        return Stroked(lying.displacements, force, answer.torque, lying=lying)

    @cached_property
    def _push(self) -> FreePush:
        return FreePush.begin(self._alone, self.rested, self.drawn, self.grips)

    @cached_property
    def _hold(self) -> FreeHold:
        return FreeHold.begin(self._alone, self.rested, self.drawn, self.grips)

    @cached_property
    def _patch(self) -> HeldPatch:
        drawn = self.drawn
        normals = drawn.node_normals[drawn.body.mesh.surface_nodes]
        return HeldPatch.of(drawn.body, self.grips, normals)


def _stroked(hand: FreePush | FreeHold, lying: Lying) -> Stroked:
    force, torque = hand.wrench
    return Stroked(
        lying.displacements,
        float(np.linalg.norm(force)),
        torque,
        touches=lying.touches,
        lying=lying,
        springs_back=hand.springs_back,
    )


def stroke_of(
    thing: bpy.types.Object, drawn: DrawnBody, grips: tuple[Grip, ...]
) -> Stroke | FreeStroke:
    """The stroke of an object: of a pinned one, or one that nobody holds.

    Raises
    ------
    PalpateError
        As of :meth:`FreeStroke.begin`.
    """
    if drawn.body.is_free:
        return FreeStroke.begin(thing, drawn, grips)
    chosen = thing.palpate
    behind = found_behind(thing, drawn)
    return Stroke(drawn, grips, chosen.young_modulus, chosen.static_friction, behind)
