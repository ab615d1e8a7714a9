"""Objects that nobody holds come down to rest, and are shown where they lie."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.contact.touches import ToolTouch
from ...core.errors import PalpateError
from ...core.rest.rest import Rest
from ...core.servo.session import Body, Prop
from ..object.drawn_body import DrawnBody, open_body
from ..played import mesh_cache
from . import rest_layer
from .free_body import FreeBody, Lying, lie, supports_under
from .free_pile import FreePile, piled
from .laid import is_animated, lay
from .standing import LANDING
from .supports import Supports
from .together import together

# Said where an object that is pressed does not come to rest.
ROLLS = "The object slides or rolls away and finds no rest; push nearer to its middle, or pin it"


@dataclass(frozen=True, eq=False)
class Alone:
    """One free body on its way, as a pile of several is."""

    free: FreeBody

    @property
    def size(self) -> float:
        """Diagonal, metres."""
        return self.free.drawn.size

    @property
    def supports(self) -> Supports:
        """What it rests on."""
        return self.free.supports

    @property
    def rest(self) -> Rest:
        """Where it is now, and what touches it."""
        return self.free.firm.rests[0]

    @property
    def bodies(self) -> tuple[SoftBody]:
        """It, at its object's density."""
        return (self.free.resting.body,)

    @property
    def native(self) -> tuple[Body, Prop]:
        """The body as a servo has it, and as it is laid down there."""
        resting = self.free.resting
        return resting.native_body, resting.laid()

    @property
    def placements(self) -> list[Pose]:
        """Where its frame is in the world."""
        return [self.free.resting.rest.placement]

    def touched_by(
        self, tools: Sequence[tuple[Tool, Pose]], placements: Sequence[Pose] | None = None
    ) -> Alone:
        """The same where it is, or at another placement, pressed by tools whose poses are in the
        world.

        Raises
        ------
        PalpateError
            Too many of them.
        """
        (placement,) = placements or self.placements
        return Alone(self.free.touched_by(tools, placement))

    def take_in_hand(self) -> None:
        """Somebody leads what presses it, and looks on."""
        self.free.firm.in_hand = True

    def close(self) -> None:
        """End what goes on in the background."""
        self.free.firm.close()

    def lead(self, goals: Sequence[Pose]) -> None:
        """Have the tools go to their goals."""
        self.free.firm.lead(goals)

    def touches(self) -> tuple[ToolTouch, ...]:
        """Of the tools, in the body's own axes."""
        return self.free.resting.tool_touches()

    def tick(self, seconds: float) -> None:
        """Go on by a tick.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        self.free.firm.hurry(seconds)

    def now(self, bent: NDArray[np.float64] | None = None) -> list[Lying]:
        """Where it is now; ``bent`` (n, 3) displaces its free surface nodes besides, metres."""
        return [self.free.now(bent)]

    def settle(self) -> list[Lying]:
        """Where it comes to rest.

        Raises
        ------
        PalpateError
            It does not.
        """
        self._drop()
        return [self.free.settle()]

    def settle_on(self, ticks: int) -> bool:
        """Go on with that by so many ticks at most; whether it rests.

        Raises
        ------
        PalpateError
            It does not.
        """
        self._drop()
        return self.free.firm.settle_on(ticks)

    def _drop(self) -> None:
        """Leave out a long way down, where no hand has it."""
        if not self.free.resting.rest.tools:
            self.free.drop(LANDING * self.size)


def settle(things: Sequence[bpy.types.Object], graph: bpy.types.Depsgraph) -> list[Lying]:
    """Let objects come to rest where they are, on each other if they are several; where each lies
    then.

    Raises
    ------
    PalpateError
        One is pinned or cannot move by itself, nothing bears it, or it does not come to rest.
    """
    coming = begun(things, graph, LANDING)
    lying = coming.settle()
    show(things, lying, coming.supports.floor)
    return lying


def begun(
    things: Sequence[bpy.types.Object], graph: bpy.types.Depsgraph, height: float
) -> Alone | FreePile:
    """The bodies of objects among what they rest on: where these are, or where nothing is near
    beneath, at a ``height`` over it, a share of their size.

    Raises
    ------
    PalpateError
        One is pinned or cannot move by itself, or nothing bears it.
    """
    opened = [open_body(thing, graph.scene) for thing in things]
    return lying_bodies(things, opened, graph, height)


def come_together(
    thing: bpy.types.Object, drawn: DrawnBody, graph: bpy.types.Depsgraph
) -> tuple[list[bpy.types.Object], Alone | FreePile]:
    """An object that will be pressed, whose body is open, and all soft ones that it rests on, in
    this order; and their bodies as of :func:`begun`, the first one steadied if it is to be.

    Raises
    ------
    PalpateError
        As of :func:`begun`.
    """
    things = together(thing, ())
    opened = [drawn, *(open_body(other, graph.scene) for other in things[1:])]
    steady = thing.palpate.steady
    return things, lying_bodies(things, opened, graph, LANDING, steady=steady)


def lying_bodies(
    things: Sequence[bpy.types.Object],
    opened: Sequence[DrawnBody],
    graph: bpy.types.Depsgraph,
    height: float,
    *,
    fingertips: Sequence[Tool] | None = None,
    steady: bool = False,
) -> Alone | FreePile:
    """The same of bodies that are open, the first one kept ``steady`` by a hand; those for a servo,
    whose ``fingertips`` are told, are touched at no more points than it has time for.

    Raises
    ------
    PalpateError
        As of :func:`begun`.
    """
    for thing in things:
        if thing.palpate.pin_mode == "NONE":
            refuse_played(thing)
    if len(things) > 1:
        return piled(things, opened, graph, height, fingertips or (), steady=steady)
    (thing,), (drawn,) = things, opened
    supports, for_servo = supports_under(thing, drawn, graph), fingertips is not None
    free = lie(thing, drawn, supports, for_servo=for_servo, steady=steady)
    free.drop(height * drawn.size)
    return Alone(free)


def show(things: Sequence[bpy.types.Object], lying: Sequence[Lying], floor: float | None) -> None:
    """Move objects to where they lie, and have them sag there; what is pinned only gives way."""
    for thing, one in zip(things, lying, strict=True):
        if one.rest.body.is_free:
            lay(thing, one.frame, floor)
        rest_layer.show(thing, one.moved)


def refuse_played(thing: bpy.types.Object) -> None:
    """Refuse an object that an animation places.

    Raises
    ------
    PalpateError
        It plays a baked animation, or has keyframes.
    """
    if mesh_cache.plays(thing) or is_animated(thing):
        raise PalpateError(
            "{name} is placed by its animation; Reset ends one that was baked, other keyframes of "
            "its place are to be cleared",
            name=thing.name,
        )
