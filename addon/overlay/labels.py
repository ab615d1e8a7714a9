"""Labels next to places in the view: numbers of fingers, forces at their arrows."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
from mathutils import Vector

from . import pixels

SIZE, PADDING, ASIDE = 13, 5, 8


@dataclass(frozen=True)
class Label:
    """Text next to a place in the region, pixels; None behind the viewer."""

    text: str
    place: Vector | None


def draw(labels: list[Label], region: bpy.types.Region, scale: float) -> None:
    """Draw labels on a dark background; overlapping ones are stacked."""
    taken: list[tuple[float, float, float, float]] = []
    size, padding = SIZE * scale, PADDING * scale
    for label in labels:
        if label.place is None:
            continue
        width, height = pixels.width_of(label.text, size) + 2 * padding, 1.6 * size
        # Readable at the rim of the view.
        x = min(max(0.0, label.place.x + ASIDE * scale), max(0.0, region.width - width))
        y = min(max(0.0, label.place.y), region.height - height)
        while any(_overlap((x, y, width, height), other) for other in taken):
            y += 1.1 * height
        taken.append((x, y, width, height))
        pixels.rectangle(x, y, width, height, pixels.BACKGROUND)
        pixels.write(label.text, x + padding, y + 0.3 * height, size, pixels.WHITE)


def _overlap(
    one: tuple[float, float, float, float], other: tuple[float, float, float, float]
) -> bool:
    return (
        one[0] < other[0] + other[2]
        and other[0] < one[0] + one[2]
        and one[1] < other[1] + other[3]
        and other[1] < one[1] + one[3]
    )
