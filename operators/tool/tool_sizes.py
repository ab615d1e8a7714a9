"""Sizes of the chosen tools: shares of the body's size, or lengths."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ..scene.drawn_surface import metres_per_unit

# Of rod and plate, in radii of the fingertip.
ROD_LENGTH, PLATE_WIDTH = 4.0, 2.5
LENGTHS = ("tip_radius", "rod_length", "plate_width", "plate_depth")


@dataclass(frozen=True)
class ToolSizes:
    """Lengths of all tools, metres."""

    tip_radius: float
    rod_length: float
    plate_width: float
    plate_depth: float

    @classmethod
    def of_share(cls, percent: float, size: float) -> ToolSizes:
        """Tools in proportion to a body of this size, metres."""
        radius = 0.01 * percent * size
        return cls(radius, ROD_LENGTH * radius, PLATE_WIDTH * radius, PLATE_WIDTH * radius)

    @property
    def lengths(self) -> dict[str, float]:
        """By the names of the scene's properties."""
        return {name: getattr(self, name) for name in LENGTHS}


def chosen_sizes(scene: bpy.types.Scene, size: float) -> ToolSizes:
    """Sizes that the scene chooses for a body of this size, metres."""
    chosen, metres = scene.palpate, metres_per_unit(scene)
    if chosen.own_sizes:
        return ToolSizes(*(metres * getattr(chosen, name) for name in LENGTHS))
    return ToolSizes.of_share(chosen.tip_share, size)


def has_exact_sizes(chosen: bpy.types.PropertyGroup) -> bool:
    """Whether a length was ever set."""
    return any(chosen.is_property_set(name) for name in LENGTHS)


def keep_exact_sizes(scene: bpy.types.Scene) -> None:
    """Let a file from before there were shares keep the lengths that it sets."""
    chosen = scene.palpate
    if has_exact_sizes(chosen) and not chosen.is_property_set("own_sizes"):
        chosen.own_sizes = True
