"""A material that suits a size: plush in a palm is hardly felt, and rubber of a house is a wall."""

from __future__ import annotations

import math

from .materials import MATERIALS

# From soft to firm, and all quick to bake but the last.
SUITABLE = ("PLUSH", "STUFFING", "FOAM", "SILICONE_SOFT")
# Of a fingertip's radius, as a share of the diagonal of what it presses.
RADIUS = 0.05
# What a fingertip should meet, newtons a metre: a hand and a desktop device feel it well.
STIFFNESS = 300.0


def material_for(diagonal: float) -> str:
    """Key of the material of which an object of this diagonal, metres, meets a fingertip best.

    A flat punch of radius a meets about 2 E a (Johnson, Contact Mechanics, 3.4, up to 1 - nu^2).

    >>> [material_for(diagonal) for diagonal in (3.5, 0.5, 0.13, 0.03)]
    ['PLUSH', 'STUFFING', 'FOAM', 'SILICONE_SOFT']
    """
    wanted = STIFFNESS / (2.0 * RADIUS * max(diagonal, 1e-6))
    return min(SUITABLE, key=lambda key: abs(math.log(MATERIALS[key].young_modulus / wanted)))
