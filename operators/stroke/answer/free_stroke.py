"""Strokes on an object that nobody holds: it gives way, is carried, and comes to rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import bpy
import numpy as np
from numpy.typing import NDArray

from ....core.errors import PalpateError
from ....core.grip.patch import Grip
from ....core.rest.refusals import RestlessError, SwallowedError
from ...lying.before import Before
from ...lying.coming_down import Alone, come_together, show
from ...lying.free_body import Lying, lie, supports_under
from ...lying.free_pile import FreePile
from ...object.drawn_body import DrawnBody
from ...scene.object_handle import ObjectHandle
from ...shape.drawn_shape import found_behind
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
    down to rest. Where a hand steadies it, that neither slides nor turns, and they stretch and bend
    it against that hand, which stays as a layer.

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
    _before: tuple[tuple[ObjectHandle, Before], ...]
    _others: tuple[Lying, ...]
    _coming: Alone | FreePile
    _drawn: DrawnBody
    pace, moves = PACE, True

    @classmethod
    def begin(
        cls, thing: bpy.types.Object, drawn: DrawnBody, grips: tuple[Grip, ...]
    ) -> FreeStroke:
        """Let the body come to rest, with all soft ones that it rests on.

        Raises
        ------
        PalpateError
            It does not, or cannot move by itself.
        """
        graph = bpy.context.evaluated_depsgraph_get()
        things, coming = come_together(thing, drawn, graph)
        rested, *others = coming.settle()
        before = tuple((ObjectHandle.of(one), Before.of(one)) for one in things)
        return cls(
            replace(drawn, frame=rested.frame),
            grips,
            thing.palpate.young_modulus,
            rested,
            before,
            tuple(others),
            coming,
            drawn,
        )

    def make_ready(self, thing: bpy.types.Object) -> None:
        """Move the object to where it came to rest, and those that it rests on."""
        show([thing], [self.rested], self._coming.supports.floor)
        self._show_others(self._others)

    def leave(self, thing: bpy.types.Object, stroked: Stroked) -> None:
        """Have the object lie where it was left."""
        if stroked.lying is not None:
            show([thing], [stroked.lying], self._coming.supports.floor)

    def follow(self, stroked: Stroked) -> None:
        """Have those that the object rests on lie where they are."""
        self._show_others(stroked.others)

    def give_back(self, thing: bpy.types.Object) -> None:
        """Have all as they were before."""
        for handle, before in self._before:
            found = handle.find()
            if found is not None:
                before.give_back(found)

    def _show_others(self, lying: Sequence[Lying]) -> None:
        for (handle, _), one in zip(self._before[1:], lying, strict=False):
            found = handle.find()
            if found is not None:
                show([found], [one], self._coming.supports.floor)

    def close(self) -> None:
        """End what goes on in the background."""
        made = self.__dict__
        if "_held" in made:
            self._held.close()
        if "_push" in made:
            self._push.free.close()

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
            return self._bent(*self._held.stroked(asked))
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
            raise refusal(hand, problem) from problem
        stroked = self._in_place(_stroked(hand, lying))
        return done, self._ending(stroked, short=done is not asked)

    def towards(self, asked: Asked) -> tuple[Asked, Stroked]:
        """The same on the way there, as far as the body goes while a picture is drawn."""
        hand = self._hand(asked)
        if hand is None:
            return self._bent(*self._held.towards(asked))
        done = self._led(hand, asked)
        for _ in range(TICKS):
            hand.free.tick(TICK)
        stroked = self._in_place(_stroked(hand, hand.free.now()))
        return done, self._ending(stroked, short=done is not asked)

    def ended(self, asked: Asked, stroked: Stroked) -> tuple[Asked, Stroked]:
        """What came of the stroke once all is at rest; of a push as far as it went, where it never
        is. What was held comes down.

        Raises
        ------
        PalpateError
            Nothing bears it where it was let go.
        """
        if stroked.springs_back and stroked.lying is not None:
            here = [stroked.lying.rest.placement, *self._coming.placements[1:]]
            let_go = self._coming.touched_by((), here)
            try:
                lying, *others = let_go.settle()
            except PalpateError as problem:
                raise PalpateError(
                    "The object does not come to rest where it was let go, and was given back: let "
                    "go above its floor or a collider"
                ) from problem
            return asked, replace(stroked, lying=lying, others=tuple(others), touches=())
        try:
            return self.stroked(asked)
        except PalpateError:
            return asked, stroked

    @property
    def _is_steady(self) -> bool:
        """Whether a hand steadies it."""
        return self.rested.rest.let_go is not None

    def _in_place(self, stroked: Stroked) -> Stroked:
        """The same of an object that lies where it rested, as one that a hand steadies does again
        once it is let go: by how far it gave way its surface is moved.
        """
        lying, frame = stroked.lying, self.rested.frame
        if not self._is_steady or lying is None:
            return stroked
        before, now = self.rested.rest.placement, lying.rest.placement
        gone = frame.local_from_body((now.position - before.position) @ before.rotation)
        moved = lying.moved + np.tile(gone.astype(np.float32), len(lying.moved) // 3)
        return replace(stroked, lying=replace(lying, frame=frame, moved=moved))

    def _ending(self, stroked: Stroked, *, short: bool) -> Stroked:
        """With why it fell short."""
        deepest = self._push.deepest if short else None
        return stroked if deepest is None else replace(stroked, ends=deepest.reason)

    def _led(self, hand: FreePush | FreeHold, asked: Asked) -> Asked:
        """Lead a hand; what is asked of it at most."""
        # Asked in the axes of the body as it was touched, which may have turned as it came to rest.
        turn = self.rested.rest.placement.rotation.T @ self._drawn.frame.rotation
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
        return None if self._is_steady else self._hold

    def _bent(self, asked: Asked, stroked: Stroked) -> tuple[Asked, Stroked]:
        """What bends it where it lies, beside how it sags there."""
        lying, *others = self._coming.now(stroked.displacements)
        bent = replace(stroked, displacements=lying.displacements)
        return asked, replace(bent, lying=lying, others=tuple(others))

    @cached_property
    def _push(self) -> FreePush:
        return FreePush.begin(self._coming, self.rested, self.drawn, self.grips)

    @cached_property
    def _hold(self) -> FreeHold:
        return FreeHold.begin(self._alone, self.rested, self.drawn, self.grips)

    @property
    def _alone(self) -> Alone:
        """The body by itself: while a hand holds it, others stand still."""
        if isinstance(self._coming, Alone):
            return self._coming
        thing = self._before[0][0].find()
        graph = bpy.context.evaluated_depsgraph_get()
        supports = supports_under(thing, self._drawn, graph)
        return Alone(lie(thing, self._drawn, supports, (), self.rested.rest.placement))

    @cached_property
    def _held(self) -> Stroke:
        """What a hand does to a patch, where the body stays where it lies."""
        thing = self._before[0][0].find()
        behind = None if thing is None else found_behind(thing, self.drawn)
        # It is not pushed so, and friction is of pushes.
        own = self.drawn, self.grips, self.young_modulus, 0.0, behind
        return Stroke(*own, is_held=self._is_steady)


def _stroked(hand: FreePush | FreeHold, all_lying: Sequence[Lying]) -> Stroked:
    (force, torque), (lying, *others) = hand.wrench, all_lying
    return Stroked(
        lying.displacements,
        float(np.linalg.norm(force)),
        torque,
        touches=lying.touches,
        lying=lying,
        others=tuple(others),
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


def refusal(hand: FreePush | FreeHold, problem: PalpateError) -> PalpateError:
    """What is said where the body does not come to rest in a hand."""
    match problem:
        case SwallowedError():
            return PalpateError(hand.swallowed)
        case RestlessError():
            return PalpateError(hand.restless)
    return problem
