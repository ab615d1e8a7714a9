"""Equation (16): from forces to large displacements, between the linear body and one loaded by F0.

With r = abs(F_j) / F0 each loaded freedom j adds ``{(1 - r) L0_j + r L_j} F_j``, L_j being the
table of the force's sign. Freedoms are superposed: what two loads do to each other is left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class PaperColumns:
    """Columns of the loaded freedoms for (16).

    Attributes
    ----------
    linear : (q, m), displacements per force of m freedoms under a small force on each of q: L0.
    positive, negative : (q, m), L^(+F0) and L^(-F0): those under +F0 and -F0, divided by these.
    largest : (q, 2), F0 for positive and for negative forces.
    """

    linear: NDArray[np.floating]
    positive: NDArray[np.floating]
    negative: NDArray[np.floating]
    largest: NDArray[np.float64]


def paper_displacements(
    columns: PaperColumns, forces: NDArray[np.float64], *, extrapolate: bool = False
) -> NDArray[np.float64]:
    """Displacements (m,) under ``forces`` (q,) on the freedoms of ``columns`` (16).

    The force divided by Young's modulus goes with tables of a body of 1 Pa, and F0 alike.

    Parameters
    ----------
    extrapolate : beyond F0 go on with (16) as it is published. It then grows with the square of the
        force, and may turn back or run away. Otherwise r stays 1: the shape under F0 grows in
        proportion. Both are continuous.
    """
    is_positive = forces > 0
    share = np.abs(forces) / np.where(is_positive, columns.largest[:, 0], columns.largest[:, 1])
    if not extrapolate:
        share = np.minimum(share, 1.0)
    corrected = share * forces
    moved: NDArray[np.float64] = (forces - corrected) @ columns.linear
    moved += (corrected * is_positive) @ columns.positive
    moved += (corrected * ~is_positive) @ columns.negative
    return moved
