"""Detection of a body that is not held, from the pivots of its elimination."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...errors import PalpateError

# A pivot below this share of its original diagonal entry is rounding. Measured,
# with Poisson's ratios up to 0.4999: at most 2e-12 for parts that hang on an edge or a node; at
# least 1e-9 for a bar 2,000 times as long as thick, 7e-8 with a core a million times as stiff.
SMALLEST_PIVOT_SHARE = 3e-11


def refuse_loose(
    breakdown: int, pivots: NDArray[np.float64], stiffness: NDArray[np.float64]
) -> None:
    """Refuse a body that can move without strain.

    Parameters
    ----------
    breakdown : of LAPACK's potrf; above 0 if a pivot was not positive.
    pivots : (p,), diagonal at elimination.
    stiffness : (p,), the diagonal as assembled.

    Raises
    ------
    PalpateError
        A pivot that is not positive, or no more than rounding of its stiffness.
    """
    if breakdown or not (pivots > SMALLEST_PIVOT_SHARE * stiffness).all():
        raise PalpateError(
            "stiffness: the body is not held by its pins, as far as its numbers tell (parts that "
            "meet only in a node or an edge can swing; stiff parts on ones a billion times softer, "
            "or a bar a thousand times as long as thick, seem to); pin each part, bake with a "
            "finer edge length so that they join, or bring factors of stiffness closer together"
        )
