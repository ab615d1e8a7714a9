"""Entries of the tables of (16) by Newton's method alone, in load steps from rest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from palpate.core.shape.paper.paper_entries import MOST_HALVINGS
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import Equilibrium, NoEquilibrium, equilibrium

# Where a body gives way is found to this share of the load; a half of it or more is what counts.
SMALLEST_STEP = 1 / 64


def unit_load(body: FreeSolid, freedom: int) -> NDArray[np.float64]:
    """Forces (f, 3): 1 N on surface freedom ``3 * (place in free_surface) + axis``."""
    node, axis = divmod(freedom, 3)
    forces = np.zeros((body.node_count, 3))
    forces[body.surface[node], axis] = 1.0
    return forces


def largest_carried(body: FreeSolid, freedom: int, wanted: float) -> tuple[float, Equilibrium]:
    """The load ``wanted`` on one freedom, halved until the body carries it; the body under it."""
    unit, load, start = unit_load(body, freedom), wanted, None
    for _ in range(MOST_HALVINGS + 1):
        try:
            return load, equilibrium(body, load * unit, start, smallest_step=SMALLEST_STEP)
        except NoEquilibrium as told:
            halved = 0.5 * load
            while abs(halved) > (told.held + SMALLEST_STEP) * abs(load):
                halved *= 0.5
            start = told.displacements * (halved / (told.held * load)) if told.held else None
            load = halved
    raise AssertionError(f"freedom {freedom} does not carry a millionth of {wanted}")
