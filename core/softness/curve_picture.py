"""SVG picture of a force-depth curve."""

from __future__ import annotations

import math
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from .force_depth import MILLIMETRES, ForceDepthCurve

WIDTH, HEIGHT = 640, 400
LEFT, RIGHT, TOP, BOTTOM = 70, 20, 40, 55
LINE, INK, GRID = "#1f7a80", "#263238", "#dfe5e8"
WANTED_TICKS = 5


def curve_svg(curve: ForceDepthCurve) -> str:
    """SVG of force in newton over depth in millimetres, with the slope in the title."""
    depths, forces = curve.depths * MILLIMETRES, curve.forces
    x_ticks, y_ticks = ticks(float(depths.max())), ticks(float(forces.max(initial=0.0)))
    x = LEFT + depths / x_ticks[-1] * (WIDTH - LEFT - RIGHT)
    y = HEIGHT - BOTTOM - forces / y_ticks[-1] * (HEIGHT - TOP - BOTTOM)
    title = f"{curve.tool}: {curve.secant / MILLIMETRES:.3g} N/mm at {depths[-1]:.3g} mm"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}">',
        f'<g font-family="DejaVu Sans, sans-serif" font-size="13" fill="{INK}">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        _text(LEFT, 24, title, "start"),
        *_vertical_lines(x_ticks),
        *_horizontal_lines(y_ticks),
        f'<polyline fill="none" stroke="{LINE}" stroke-width="2" points="{_points(x, y)}"/>',
        _text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12, "depth, mm", "middle"),
        f'<g transform="translate(18 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)">',
        _text(0, 0, "force, N", "middle"),
        "</g></g></svg>",
    ]
    return "\n".join(parts) + "\n"


def ticks(highest: float) -> NDArray[np.float64]:
    """Round numbers from 0 to at least ``highest``: steps of 1, 2 or 5 times a power of ten."""
    if highest <= 0.0:
        return np.array([0.0, 1.0])
    rough = highest / WANTED_TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(s * power for s in (1.0, 2.0, 5.0, 10.0) if s * power >= rough * (1 - 1e-9))
    count = math.ceil(highest / step - 1e-9) + 1
    values: NDArray[np.float64] = step * np.arange(count, dtype=np.float64)
    return values


def _vertical_lines(values: NDArray[np.float64]) -> list[str]:
    lines = []
    for value in values.tolist():
        x = LEFT + value / values[-1] * (WIDTH - LEFT - RIGHT)
        lines.append(f'<path d="M{x:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="{GRID}"/>')
        lines.append(_text(x, HEIGHT - BOTTOM + 18, f"{value:.4g}", "middle"))
    return lines


def _horizontal_lines(values: NDArray[np.float64]) -> list[str]:
    lines = []
    for value in values.tolist():
        y = HEIGHT - BOTTOM - value / values[-1] * (HEIGHT - TOP - BOTTOM)
        lines.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="{GRID}"/>')
        lines.append(_text(LEFT - 8, y + 4, f"{value:.4g}", "end"))
    return lines


def _points(x: NDArray[np.float64], y: NDArray[np.float64]) -> str:
    return " ".join(f"{a:.2f},{b:.2f}" for a, b in zip(x.tolist(), y.tolist(), strict=True))


def _text(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'
