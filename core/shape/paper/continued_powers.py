"""s^2 and s^3 as far as a series holds, and their tangents beyond.

What is drawn with them is once continuously differentiable in the force, through zero and beyond
the largest force of the series, where it goes on straight: a polynomial would run away.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def continued_powers(
    share: ArrayLike, largest: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Stand-ins for s^2 and s^3 at shares s (k,), the series holding up to |s| = ``largest`` (k,).

    Beyond, 2 c |s| - c^2 and sign(s) (3 c^2 |s| - 2 c^3) with c the largest share.
    """
    size = np.abs(np.asarray(share, dtype=np.float64))
    held = np.minimum(size, largest)
    square = held * (2.0 * size - held)
    cube = np.copysign(held**2 * (3.0 * size - 2.0 * held), share)
    return square, cube
