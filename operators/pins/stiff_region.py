"""Stiff region of an object: a vertex group and a factor on its material."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ...core.stiffness.regions import StiffRegion
from ..scene.drawn_surface import DrawnSurface
from .group_digest import group_digest


def stiff_rule(thing: bpy.types.Object) -> str:
    """Text that changes with the object's stiff region; empty for none."""
    settings = thing.palpate
    if not settings.stiff_group:
        return ""
    group = thing.vertex_groups.get(settings.stiff_group)
    if group is None:
        return "no group"
    return f"{settings.stiff_factor:.6g} times in {group_digest(thing, group)}"


def stiff_region(thing: bpy.types.Object, surface: DrawnSurface) -> StiffRegion | None:
    """Stiff region for a bake, one weight per vertex of a surface; None if none is chosen.

    Raises
    ------
    PalpateError
        The vertex group is missing, or nothing is in it.
    """
    settings = thing.palpate
    if not settings.stiff_group:
        return None
    group = thing.vertex_groups.get(settings.stiff_group)
    if group is None:
        raise PalpateError(
            "{name}: it has no vertex group '{group}' to make stiff; choose one under Stiff "
            "Region, or clear the field",
            name=thing.name,
            group=settings.stiff_group,
        )
    weights = surface.group(thing, group.name)
    if not weights.any():
        raise PalpateError(
            "{name}: no vertex has a weight in the group '{group}', so nothing would be stiff; "
            "assign the vertices of the stiff part, or clear the field",
            name=thing.name,
            group=group.name,
        )
    return StiffRegion(weights, settings.stiff_factor)
