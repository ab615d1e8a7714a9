"""Objects that nobody holds come down to rest, and are shown where they lie."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from ...core.errors import PalpateError
from ..object.drawn_body import open_body
from ..played import mesh_cache
from . import rest_layer
from .free_body import LANDING, FreeBody, Lying, lie, supports_under
from .free_pile import FreePile, piled
from .laid import is_animated, lay


@dataclass(frozen=True, eq=False)
class Alone:
    """One free body on its way, as a pile of several is."""

    free: FreeBody

    @property
    def size(self) -> float:
        """Diagonal, metres."""
        return self.free.drawn.size

    @property
    def floor(self) -> float | None:
        """Height of the floor, metres; None without one."""
        return self.free.supports.floor

    def tick(self, seconds: float) -> None:
        """Go on by a tick.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        self.free.resting.tick(seconds, hurried=True)

    def now(self) -> list[Lying]:
        """Where it is now."""
        return [self.free.now()]

    def settle(self) -> list[Lying]:
        """Where it comes to rest.

        Raises
        ------
        PalpateError
            It does not.
        """
        return [self.free.come_down()]


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
    show(things, lying, coming.floor)
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
    for thing in things:
        if thing.palpate.pin_mode == "NONE":
            refuse_played(thing)
    if len(things) > 1:
        return piled(things, graph, height)
    (thing,) = things
    drawn = open_body(thing, graph.scene)
    free = lie(thing, drawn, supports_under(thing, drawn, graph))
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
