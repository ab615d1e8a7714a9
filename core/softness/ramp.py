"""Colour map that everybody can read: dark blue to yellow, of rising lightness.

Anchors after *cividis* (Nunez, Anderton and Renslow 2018, PLOS ONE 13, e0199239), designed for
people with and without colour vision deficiency.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

# sRGB, 0 to 255, at equal steps.
ANCHORS = np.array(
    [
        [0, 34, 78],
        [33, 61, 107],
        [76, 85, 108],
        [108, 110, 114],
        [142, 137, 120],
        [178, 165, 112],
        [215, 196, 92],
        [253, 231, 55],
    ],
    dtype=np.float64,
)


def ramp(shares: ArrayLike) -> NDArray[np.float64]:
    """Colours (k, 3), sRGB from 0 to 1 for ``shares`` (k,) from 0, dark, to 1, light."""
    at = np.clip(np.asarray(shares, dtype=np.float64), 0.0, 1.0) * (len(ANCHORS) - 1)
    steps = np.arange(len(ANCHORS))
    colours = np.column_stack([np.interp(at, steps, anchor) for anchor in ANCHORS.T])
    scaled: NDArray[np.float64] = colours / 255.0
    return scaled


def legend(low: float, high: float, count: int = 5) -> list[tuple[float, NDArray[np.float64]]]:
    """Values at equal ratios from ``low`` to ``high`` with their colours (3,)."""
    values = np.geomspace(low, high, count)
    return list(zip(values.tolist(), ramp(np.linspace(0.0, 1.0, count)), strict=True))
