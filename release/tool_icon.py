"""Draw the tool's icon: `python release/tool_icon.py` writes addon/toolbar/palpate_icon.dat.

Blender's format: "VCO", a zero, the extents, two unused bytes; then two bytes a corner for all
triangles, then red, green, blue and opacity of each corner.
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

FILE = Path(__file__).resolve().parents[1] / "addon" / "toolbar" / "palpate_icon.dat"
SURFACE, FINGER = (210, 210, 210, 255), (90, 165, 225, 255)
# The dent in the surface, and the ball that made it, of 255 by 255.
LEVEL, DEPTH, HALF_WIDTH, THICKNESS = 118.0, 62.0, 52.0, 26.0
BALL, BALL_RADIUS = (127.5, 132.0), 56.0
STEPS = 28

Point = tuple[float, float]
Triangle = tuple[Point, Point, Point]
Colour = tuple[int, int, int, int]


def icon() -> bytes:
    """Return the icon's file."""
    coloured = [(one, SURFACE) for one in _surface()] + [(one, FINGER) for one in _ball()]
    corners = bytes(round(number) for one, _ in coloured for point in one for number in point)
    colours = bytes(part for _, colour in coloured for _ in range(3) for part in colour)
    return b"VCO\0" + bytes((255, 255, 0, 0)) + corners + colours


def _surface() -> list[Triangle]:
    """A band that dips below the ball."""
    tops = [_dented(14.0 + 227.0 * step / STEPS) for step in range(STEPS + 1)]
    triangles: list[Triangle] = []
    for here, there in pairwise(tops):
        below, beyond = (here[0], here[1] - THICKNESS), (there[0], there[1] - THICKNESS)
        triangles += [(below, beyond, there), (below, there, here)]
    return triangles


def _dented(x: float) -> Point:
    away = (x - BALL[0]) / HALF_WIDTH
    return x, LEVEL - DEPTH * math.exp(-(away**2))


def _ball() -> list[Triangle]:
    around = [
        (
            BALL[0] + BALL_RADIUS * math.cos(2.0 * math.pi * step / STEPS),
            BALL[1] + BALL_RADIUS * math.sin(2.0 * math.pi * step / STEPS),
        )
        for step in range(STEPS + 1)
    ]
    # Above the dent.
    middle = (BALL[0], BALL[1] + 40.0)
    lifted = [(x, y + 40.0) for x, y in around]
    return [(middle, here, there) for here, there in pairwise(lifted)]


if __name__ == "__main__":
    FILE.write_bytes(icon())
