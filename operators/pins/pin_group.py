"""Pins: a painted vertex group, or all vertices below a height, which makes one."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.stiffness.pins import NoPins, PinCore, PinWeights
from ..scene.drawn_surface import DrawnSurface, group_weights
from .group_digest import group_digest

GROUP_NAME = "Pinned"
# Weight from which on a place is pinned.
PINNED_FROM = 0.5
# Tolerance for rounding of a level bottom, as a share of the height.
LEVEL = 1e-5


def pin_rule(thing: bpy.types.Object) -> str:
    """Text that changes with the object's pins."""
    settings = thing.palpate
    if settings.pin_mode == "BELOW":
        return f"below {settings.pin_fraction:.4f}"
    if settings.pin_mode in {"CORE", "NONE"}:
        return str(settings.pin_mode.lower())
    group = thing.vertex_groups.get(settings.pin_group)
    if group is None:
        return "no group"
    return f"group {group_digest(thing, group)}"


def pins(thing: bpy.types.Object, surface: DrawnSurface) -> PinWeights | PinCore | NoPins:
    """Pins for a bake.

    Raises
    ------
    PalpateError
        The vertex group is missing or empty.
    """
    match thing.palpate.pin_mode:
        case "NONE":
            return NoPins()
        case "BELOW" | "GROUP":
            return pinned_from(thing, surface)
    x, y, z = (float(one) for one in up_in_body(surface))
    return PinCore(up=(x, y, z))


def pinned_from(thing: bpy.types.Object, surface: DrawnSurface) -> PinWeights:
    """Pins of the surface, one weight per vertex, pinned where it reaches one half.

    A height is given as weights linear in it, which are exact between vertices of any mesh.

    Raises
    ------
    PalpateError
        The vertex group is missing or empty.
    """
    settings = thing.palpate
    if settings.pin_mode == "BELOW":
        height = _relative_height(surface)
        return PinWeights(PINNED_FROM + settings.pin_fraction + LEVEL - height)
    return painted(thing, surface)


def is_painted(thing: bpy.types.Object, surface: DrawnSurface) -> bool:
    """Whether an object has the vertex group of its pins, with a vertex that it pins."""
    group = thing.vertex_groups.get(thing.palpate.pin_group)
    return group is not None and bool((surface.group(thing, group.name) >= PINNED_FROM).any())


def painted(thing: bpy.types.Object, surface: DrawnSurface | None = None) -> PinWeights:
    """Pins of the vertex group that is chosen, at the vertices of a surface or of the mesh.

    Raises
    ------
    PalpateError
        The vertex group is missing or empty.
    """
    settings = thing.palpate
    group = thing.vertex_groups.get(settings.pin_group)
    if group is None:
        raise PalpateError(
            "{name}: it has no vertex group '{group}' to pin; choose one under Pins, or pin below "
            "a height",
            name=thing.name,
            group=settings.pin_group,
        )
    if surface is None:
        weights = group_weights(thing.data, group.index)
    else:
        weights = surface.group(thing, group.name)
    if not (weights >= PINNED_FROM).any():
        raise PalpateError(
            "{name}: no vertex has a weight of 0.5 or more in the group '{group}'; assign the "
            "vertices that shall not move",
            name=thing.name,
            group=group.name,
        )
    return PinWeights(weights)


def mark_below(
    thing: bpy.types.Object, surface: DrawnSurface, fraction: float
) -> tuple[bpy.types.VertexGroup, int]:
    """Group all vertices below ``fraction`` of the height; the group, and their number.

    Up is the world's Z axis, as the object stands now. A group that was painted stays as it is.
    """
    group = thing.vertex_groups.get(GROUP_NAME)
    if group is None or not _is_below_a_height(group_weights(thing.data, group.index), surface):
        group = thing.vertex_groups.new(name=GROUP_NAME)
    pinned = np.flatnonzero(is_below(surface, fraction))
    group.remove(range(len(surface.local)))
    group.add(pinned.tolist(), 1.0, "REPLACE")
    return group, len(pinned)


def _is_below_a_height(weights: NDArray[np.float64], surface: DrawnSurface) -> bool:
    """Whether weights (p,) say no more than a height: 1 up to it, 0 above."""
    height, held = _relative_height(surface), weights == 1.0
    highest, lowest = height[held].max(initial=-np.inf), height[~held].min(initial=np.inf)
    return bool(not weights[~held].any() and highest < lowest)


def is_below(surface: DrawnSurface, fraction: float) -> NDArray[np.bool_]:
    """Which vertices are in the lowest ``fraction`` of the height."""
    low: NDArray[np.bool_] = _relative_height(surface) <= fraction + LEVEL
    return low


def up_in_body(surface: DrawnSurface) -> NDArray[np.float64]:
    """The world's Z axis, a unit vector (3,) in body coordinates."""
    return surface.frame.turn_to_body(np.array([0.0, 0.0, 1.0]))


def _relative_height(surface: DrawnSurface) -> NDArray[np.float64]:
    height = surface.body @ up_in_body(surface)
    if not height.size:
        return height
    used = height[surface.triangles.ravel()] if surface.triangles.size else height
    low, span = used.min(), np.ptp(used)
    relative: NDArray[np.float64] = (height - low) / (span or 1.0)
    return relative
