"""Pins of an object whose pins nobody has chosen: its pin group; none where it stands; or its core
on a slender foot.
"""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.sentence import Sentence
from ..scene.drawn_surface import DrawnSurface
from .pin_group import is_below, is_painted, up_in_body

# So many times as high as its foot is wide: pinned there, what stands on it leans instead of giving
# way where it is pressed. A koala of 1.7, pinned by its foot, leant by more than its dent in 27 of
# 40 pushes.
SLENDER = 1.2
DIRECTIONS = 36


def choose(
    thing: bpy.types.Object,
    surface: DrawnSurface,
    *,
    by_hand: bool,
    stands: Callable[[], bool],
) -> Sentence | None:
    """Choose the pins of an object if nobody has; what is to be told of that.

    It is the vertex group of that name, if it has one. Where somebody looks on (``by_hand``), one
    that ``stands`` rests there, steadied by a hand; another one is held by its core if its foot is
    slender.
    """
    settings = thing.palpate
    if settings.is_property_set("pin_mode") or settings.is_property_set("pin_fraction"):
        return None
    if is_painted(thing, surface):
        settings.pin_mode = "GROUP"
        return Sentence(
            "{name} is pinned by its vertex group {group}. Pins chooses otherwise",
            name=thing.name,
            group=settings.pin_group,
        )
    if by_hand and stands():
        settings.pin_mode, settings.steady = "NONE", True
        return Sentence(
            "{name} rests on its floor, and a hand steadies it while you press. Pins chooses "
            "otherwise",
            name=thing.name,
        )
    if not (by_hand and is_slender(surface, settings.pin_fraction)):
        return None
    settings.pin_mode = "CORE"
    return Sentence(
        "{name} stands on a slender foot and would lean; it is held by its core. Pins chooses "
        "otherwise",
        name=thing.name,
    )


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
