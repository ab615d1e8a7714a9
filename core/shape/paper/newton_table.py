"""The tables of (16): each freedom of the surface loaded alone by +F0 and by -F0, solved exactly.

Where the solid does not carry F0 - St. Venant-Kirchhoff bodies collapse under strong compression,
and a corner that only one tetrahedron holds folds over - F0 is halved for that freedom and sign
until it does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...mesh.tet_mesh import TetMesh
from ...progress import unwatched
from ..solid.free_solid import FreeSolid
from ..solid.newton import Equilibrium, NoEquilibrium, equilibrium

SIGNS = (1.0, -1.0)

# After so many halvings a freedom is left linear: F0 is a millionth of what was wanted.
MOST_HALVINGS = 20

# Where a body gives way is found to this share of the load; a half of it or more is what counts.
SMALLEST_STEP = 1 / 64

# F0 when no other is asked for: the paper's 2 N on its cube of 50 mm and 10 kPa, as a share of
# Young's modulus times the square of the body's smallest extent.
PAPER_SHARE = 2.0 / (10_000.0 * 0.05**2)


@dataclass(frozen=True, eq=False)
class TableColumn:
    """One freedom's entries for both signs, at unit modulus.

    Attributes
    ----------
    per_force : float32 (2, 3n), displacements of the free surface nodes under +F0 and -F0, divided
        by +F0 and -F0.
    largest : float64 (2,), those F0; newton per pascal of Young's modulus.
    """

    per_force: NDArray[np.float32]
    largest: NDArray[np.float64]


def newton_column(
    body: FreeSolid, freedom: int, wanted: float, may_go_on: Callable[[], None] = unwatched
) -> TableColumn:
    """The entries of surface freedom ``3 * (place in free_surface) + axis`` for F0 = ``wanted``.

    ``wanted`` is in newton per pascal of Young's modulus; see :func:`largest_carried` where the
    body does not carry it. ``may_go_on`` is called now and then; it may raise to cancel.
    """
    rows, largest = [], []
    for sign in SIGNS:
        load, found = largest_carried(body, freedom, sign * wanted, may_go_on)
        rows.append(found.displacements[body.surface].ravel() / load)
        largest.append(abs(load))
    return TableColumn(np.array(rows, dtype=np.float32), np.array(largest))


def largest_carried(
    body: FreeSolid, freedom: int, wanted: float, may_go_on: Callable[[], None] = unwatched
) -> tuple[float, Equilibrium]:
    """The load ``wanted`` on one surface freedom, halved until the body carries it.

    Returns the load and the body under it. Displacements are the linear ones, and the load is
    ``wanted``, if even a millionth of it has no equilibrium.
    """
    node, axis = divmod(freedom, 3)
    unit = np.zeros((body.node_count, 3))
    unit[body.surface[node], axis] = 1.0
    load, start = wanted, None
    for _ in range(MOST_HALVINGS + 1):
        try:
            found = equilibrium(
                body, load * unit, start, smallest_step=SMALLEST_STEP, may_go_on=may_go_on
            )
        except NoEquilibrium as told:
            halved = 0.5 * load
            while abs(halved) > (told.held + SMALLEST_STEP) * abs(load):
                halved *= 0.5
            start = told.displacements * (halved / (told.held * load)) if told.held else None
            load = halved
        else:
            return load, found
    linear = wanted * body.linear(unit)
    return wanted, Equilibrium(linear, 0, 0, np.nan, ())


def usual_largest_force(mesh: TetMesh) -> float:
    """F0 at unit modulus, square metres, for a body of any size: the paper's cube's, scaled."""
    extent = float(np.ptp(mesh.nodes, axis=0).min())
    return PAPER_SHARE * extent**2
