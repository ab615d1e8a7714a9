"""An object that nobody holds comes down to rest, and is shown where it lies."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ..object.drawn_body import open_body
from ..played import mesh_cache
from . import rest_layer
from .free_body import FreeBody, Lying, lie, supports_under
from .laid import is_animated, lay


def settle(thing: bpy.types.Object, graph: bpy.types.Depsgraph) -> Lying:
    """Let an object come to rest where it is; where it lies then.

    Raises
    ------
    PalpateError
        It is pinned or cannot move by itself, nothing bears it, or it does not come to rest.
    """
    free = begun(thing, graph)
    lying = free.come_down()
    show(thing, lying, free.supports.floor)
    return lying


def begun(thing: bpy.types.Object, graph: bpy.types.Depsgraph) -> FreeBody:
    """The free body of an object where it is, among what it rests on.

    Raises
    ------
    PalpateError
        It is pinned or cannot move by itself, or nothing bears it.
    """
    refuse_played(thing)
    drawn = open_body(thing, graph.scene)
    return lie(thing, drawn, supports_under(thing, drawn, graph))


def show(thing: bpy.types.Object, lying: Lying, floor: float | None) -> None:
    """Move an object to where it lies, and have it sag there."""
    lay(thing, lying.frame, floor)
    rest_layer.show(thing, lying.moved)


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
