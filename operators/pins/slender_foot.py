"""Slender foot: pinned there, what stands on it leans instead of giving way where it is pressed."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..scene.drawn_surface import DrawnSurface
from .pin_group import is_below, up_in_body

# So many times as high as its foot is wide. A koala of 1.7, pinned by its foot, leant by more than
# its dent in 27 of 40 pushes.
SLENDER = 1.2
DIRECTIONS = 36


def hold_by_core(thing: bpy.types.Object, surface: DrawnSurface) -> bool:
    """Hold an object by its core if its foot is slender and nobody has chosen its pins; returns
    whether it now is.
    """
    settings = thing.palpate
    chosen = settings.is_property_set("pin_mode") or settings.is_property_set("pin_fraction")
    if chosen or not is_slender(surface, settings.pin_fraction):
        return False
    settings.pin_mode = "CORE"
    return True


def is_slender(surface: DrawnSurface, fraction: float) -> bool:
    """Whether a body is high beside the width of its lowest ``fraction``, by which it is pinned."""
    used = np.unique(surface.triangles)
    if not used.size:
        return False
    up = up_in_body(surface)
    foot = surface.body[used[is_below(surface, fraction)[used]]]
    return bool(np.ptp(surface.body[used] @ up) > SLENDER * _width(foot, up))


def _width(places: NDArray[np.float64], up: NDArray[np.float64]) -> float:
    """The least extent of places (n, 3) in some directions across ``up``, m."""
    angles = np.linspace(0.0, np.pi, DIRECTIONS, endpoint=False)
    across = np.linalg.svd(up[None, :])[2][1:]
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1) @ across
    return float(np.ptp(places @ directions.T, axis=0).min())
