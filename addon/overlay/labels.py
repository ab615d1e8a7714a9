"""Labels of values: forces at their arrows, pressure next to its colours."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import bpy
from mathutils import Vector

from ...operators.reporting.translated import shown
from . import pixels
from .pressure_colors import ANCHORS

SIZE, PADDING, ASIDE = 13, 5, 8
# Legend: distance from the right, width of the bar, space between bar and figures, margin.
MARGIN, BAR_WIDTH, BAR_HEIGHT, GAP, AROUND = 24, 14, 130, 6, 10
# Height of Blender's view buttons at the top, headers included.
NAVIGATION = 300


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


def draw_legend(context: bpy.types.Context, top: float) -> None:
    """Draw the colours of pressure from 0 to ``top`` (Pa), at the right of the view, half way
    up or below Blender's buttons.
    """
    scale = context.preferences.system.ui_scale
    size, bar, height = SIZE * scale, BAR_WIDTH * scale, BAR_HEIGHT * scale
    title = shown("Pressure")
    figures = [f"{top * share / 1000:g} kPa" for share in (0.0, 0.5, 1.0)]
    across = max(
        pixels.width_of(title, size),
        bar + GAP * scale + max(pixels.width_of(figure, size) for figure in figures),
    )
    right = context.region.width - pixels.covered(context, "UI", "RIGHT") - MARGIN * scale
    around = AROUND * scale
    left = right - across
    bottom = legend_bottom(context.region.height, height, scale)
    pixels.rectangle(
        left - around,
        bottom - around - 0.5 * size,
        across + 2 * around,
        height + 2 * around + 3.0 * size,
        pixels.BACKGROUND,
    )
    step = height / (len(ANCHORS) - 1)
    for number, (lower, upper) in enumerate(pairwise(ANCHORS)):
        below, above = (*lower.tolist(), 1.0), (*upper.tolist(), 1.0)
        pixels.shaded(left, bottom + number * step, bar, step, [below, below, above, above])
    for share, figure in zip((0.0, 0.5, 1.0), figures, strict=True):
        y = bottom + share * height - 0.35 * size
        pixels.write(figure, left + bar + GAP * scale, y, size, pixels.WHITE)
    pixels.write(title, left, bottom + height + 1.0 * size, size, pixels.WHITE)


def legend_bottom(region_height: float, height: float, scale: float) -> float:
    """Bottom of a bar of this height: half way up, or below Blender's buttons."""
    above, below = (2.5 * SIZE + AROUND) * scale, (0.5 * SIZE + AROUND) * scale
    free = region_height - NAVIGATION * scale - height - above
    return max(below, min(0.5 * (region_height - height), free))
