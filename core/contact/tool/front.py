"""Fronts of convex tools: how wide what touches first is.

A cone on a wide base touches with its tip: points an eighth of the base apart would meet it seldom,
and then with the firmness of their whole shares. But as many points as a tick looks at must still
reach as far as the tool is pressed in, so a pointed tool has them as close as lets it sink in by a
good half; pressed with its wide side it is felt too soft by a quarter.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

# Depth of a front, as a share of the tool's height over it. A ball is four fifths as wide there as
# in its middle, a cone a fifth.
FRONT = 0.2

# Fronts less wide than this share of what is behind them are pointed.
POINTED = 0.5

# The share of the outline behind a pointed front that points at least reach over: as many as a tick
# looks at (``MOST_NEAR`` of native/src/tool/slot.rs), so many on a spacing squared.
REACHED = 0.25
MOST_NEAR = 160
POINTS_PER_SPACING_SQUARED = 1.4


def pointed_spacing(core: NDArray[np.float64], faces: NDArray[np.int64], per_width: float) -> float:
    """Spacing of contact points, metres, that the most pointed front asks for; else infinite.

    Fronts are looked at along the tool's own axes, in both directions.

    Parameters
    ----------
    core : (k, 3), corners of a hull with volume, metres.
    faces : (f, 3), its triangles.
    per_width : spacing over the width of a front.
    """
    found = float("inf")
    for axis in range(3):
        outline = _area(np.delete(core, axis, axis=1))
        low, high = core[:, axis].min(), core[:, axis].max()
        for share in (FRONT, 1.0 - FRONT):
            front = _section(core, faces, axis, low + share * (high - low))
            if front < POINTED**2 * outline:
                closest = np.sqrt(POINTS_PER_SPACING_SQUARED * REACHED * outline / MOST_NEAR)
                found = min(found, max(per_width * np.sqrt(front), float(closest)))
    return found


def _section(core: NDArray[np.float64], faces: NDArray[np.int64], axis: int, level: float) -> float:
    """Area of what a hull has at a level of an axis, square metres."""
    ends = core[np.concatenate([np.roll(faces, turn, axis=1)[:, :2] for turn in range(3)])]
    below, above = ends[:, 0, axis], ends[:, 1, axis]
    crossing = (below < level) != (above < level)
    first, second = ends[crossing, 0], ends[crossing, 1]
    share = (level - first[:, axis]) / (second[:, axis] - first[:, axis])
    return _area(np.delete(first + share[:, None] * (second - first), axis, axis=1))


def _area(places: NDArray[np.float64]) -> float:
    """Area of the convex outline of places (p, 2), square metres."""
    return float(ConvexHull(places).volume)
