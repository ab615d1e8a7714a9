"""An object that nobody holds comes down to rest, and is shown where it lies."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ..object.drawn_body import open_body
from ..played import mesh_cache
from . import rest_layer
from .free_body import Lying, lie, supports_under
from .laid import is_animated, lay


def settle(thing: bpy.types.Object, graph: bpy.types.Depsgraph) -> Lying:
    """Let an object come to rest where it is; where it lies then.

    Raises
    ------
    PalpateError
        It is pinned or cannot move by itself, nothing bears it, or it does not come to rest.
    """
    refuse_played(thing)
    drawn = open_body(thing, graph.scene)
    supports = supports_under(thing, drawn, graph)
    lying = lie(thing, drawn, supports).come_down()
    show(thing, lying, supports.floor)
    return lying


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
