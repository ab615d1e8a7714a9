"""Body of an object that something holds: its pins, or the hand that steadies it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import bpy

from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ..object.drawn_body import DrawnBody, open_body


def open_held(thing: bpy.types.Object, scene: bpy.types.Scene) -> DrawnBody:
    """Load an object's body as :func:`open_body`, one that something holds: its pins, or the hand
    that steadies it.

    Raises
    ------
    PalpateError
        As there; nothing holds it.
    """
    return held(thing, open_body(thing, scene))


def held(thing: bpy.types.Object, drawn: DrawnBody) -> DrawnBody:
    """The same of a body that is open; errors as there."""
    if not drawn.body.is_free or drawn.body.in_hand:
        return drawn
    if not thing.palpate.steady:
        raise PalpateError(
            "{name}: nothing holds it, so it would move away under this; push it by a stroke, "
            "press it by Bake Animation, or choose Steady or other Pins",
            name=thing.name,
        )
    return replace(drawn, body=_in_hand(drawn.body))


@lru_cache(maxsize=4)
def _in_hand(body: SoftBody) -> SoftBody:
    """The same body each time: much is kept with it."""
    return replace(body, in_hand=True)
