"""Text and rectangles in a view, in pixels."""

from __future__ import annotations

from collections.abc import Sequence

import blf
import gpu
from gpu_extras.batch import batch_for_shader

Color = tuple[float, float, float, float]

FONT = 0
WHITE, BLACK = (1.0, 1.0, 1.0, 1.0), (0.0, 0.0, 0.0, 1.0)
BACKGROUND = (0.05, 0.05, 0.06, 0.72)


def width_of(text: str, size: float) -> float:
    """Width of a text of this size."""
    blf.size(FONT, size)
    return blf.dimensions(FONT, text)[0]


def write(text: str, x: float, y: float, size: float, color: Color) -> None:
    """Draw a text from the left end of its base line."""
    blf.size(FONT, size)
    blf.color(FONT, *color)
    blf.position(FONT, x, y, 0)
    blf.draw(FONT, text)


def rectangle(x: float, y: float, width: float, height: float, color: Color) -> None:
    """Fill a rectangle, by its lower left corner."""
    shaded(x, y, width, height, [color] * 4)


def shaded(x: float, y: float, width: float, height: float, colors: Sequence[Color]) -> None:
    """Fill a rectangle with colours at its corners, counter-clockwise from the lower left."""
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    batch = batch_for_shader(
        shader, "TRIS", {"pos": corners, "color": colors}, indices=[(0, 1, 2), (0, 2, 3)]
    )
    gpu.state.blend_set("ALPHA")
    batch.draw(shader)
    gpu.state.blend_set("NONE")
