"""Pressure as colour: the map viridis (van der Walt and Smith 2015), also readable for colour-blind
people and in print, and a scale of round numbers that does not flicker.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_VIRIDIS = "440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725"
ANCHORS = np.array([[int(c[i : i + 2], 16) / 255 for i in (0, 2, 4)] for c in _VIRIDIS.split()])
# The scale is reduced when less than this share of it is used.
LEAST_USED = 0.3
SMALLEST_SCALE = 1.0


def color_of(share: ArrayLike) -> Array:
    """Colours (..., 3) of shares 0..1 of the scale; the last one beyond."""
    at = np.clip(np.asarray(share, dtype=np.float64), 0.0, 1.0) * (len(ANCHORS) - 1)
    low = np.minimum(at.astype(np.int64), len(ANCHORS) - 2)
    part = (at - low)[..., None]
    colors: Array = (1.0 - part) * ANCHORS[low] + part * ANCHORS[low + 1]
    return colors


def round_up(pressure: float) -> float:
    """Smallest of 1, 2, 5, 10, 20, ... Pa that is no less."""
    if pressure <= SMALLEST_SCALE:
        return SMALLEST_SCALE
    decade = 10.0 ** np.floor(np.log10(pressure))
    # The logarithm of a power of ten may be rounded down.
    steps = (decade, 2 * decade, 5 * decade, 10 * decade)
    return float(next(step for step in steps if step >= pressure * (1.0 - 1e-9)))


@dataclass(eq=False)
class PressureScale:
    """Scale whose ``top`` (Pa) has the last colour and follows the pressure in round numbers."""

    top: float = SMALLEST_SCALE

    def follow(self, largest: float) -> float:
        """Adapt the scale to the present largest pressure if necessary; returns ``top``."""
        if largest > self.top or 0.0 < largest < LEAST_USED * self.top:
            self.top = round_up(largest)
        return self.top
