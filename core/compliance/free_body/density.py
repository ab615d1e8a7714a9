"""Density of a body: what it weighs, and nothing of its compliance."""

from __future__ import annotations

import math
from typing import Final

from ...errors import PalpateError

# Of water, kg/m3: silicone, gelatine and flesh are within a tenth of it.
DEFAULT_DENSITY: Final = 1_000.0
# Aerogel is lighter than nothing else that is solid, osmium heavier.
LEAST_DENSITY: Final = 0.1
MOST_DENSITY: Final = 25_000.0


def density_checked(density: float) -> float:
    """``density`` in kg/m3, if a solid can have it.

    Raises
    ------
    PalpateError
        It is out of range, or no number.
    """
    if not (math.isfinite(density) and LEAST_DENSITY <= density <= MOST_DENSITY):
        raise PalpateError(
            "the density is {density} kg/m3, but must lie between {least:g} and {most:g}; foam has "
            "25 to 100, silicone about 1070",
            density=density,
            least=LEAST_DENSITY,
            most=MOST_DENSITY,
        )
    return density
