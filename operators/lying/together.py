"""Soft objects that come to rest together: those that are chosen, and those that they rest on."""

from __future__ import annotations

from collections.abc import Sequence

import bpy


def together(thing: bpy.types.Object, chosen: Sequence[bpy.types.Object]) -> list[bpy.types.Object]:
    """An object, those ``chosen`` that nobody holds either, and all soft ones among the colliders
    of these and of theirs; the object itself comes first.
    """
    free = (one for one in chosen if is_soft(one) and one.palpate.pin_mode == "NONE")
    found = [thing, *(one for one in free if one != thing)]
    # The list grows as it is gone through.
    for one in found:
        found.extend(other for other in soft_colliders(one) if other not in found)
    return found


def soft_colliders(thing: bpy.types.Object) -> list[bpy.types.Object]:
    """Soft objects that bear an object without pins, and give way; none of others."""
    settings = thing.palpate
    if settings.pin_mode != "NONE" or settings.colliders is None:
        return []
    return [one for one in settings.colliders.all_objects if one != thing and is_soft(one)]


def is_soft(thing: bpy.types.Object) -> bool:
    """Whether an object has a body."""
    return thing.type == "MESH" and bool(thing.palpate.body_key)
