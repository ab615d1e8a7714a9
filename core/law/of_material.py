"""The law of a body's material, by what is known of it."""

from __future__ import annotations

from .foam import Foam
from .law import Law
from .neo_hookean import NeoHookean


def law_of(poisson_ratio: float) -> Law:
    """The law of a material of which only Poisson's ratio is known.

    Neo-Hookean; where a material widens as it is pulled (cork has 0, auxetic foam less) the law of
    foam, which is stable there too.
    """
    return NeoHookean() if poisson_ratio >= 0.0 else Foam(poisson_ratio)
