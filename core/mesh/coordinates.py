"""Range of usable coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError

# Far beyond any prop; products of larger numbers may overflow.
LARGEST_COORDINATE = 1e9


def refuse_unusable(what: str, points: NDArray[np.float64]) -> None:
    """Check that ``points`` (p, 3), metres, of ``what`` are finite and in range.

    Raises
    ------
    PalpateError
        Some are not; it names the first.
    """
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        raise PalpateError(
            "{what}: {count} points have coordinates that are not finite numbers (first: number "
            "{first}); delete or repair them",
            what=what,
            count=int(bad.sum()),
            first=int(np.flatnonzero(bad)[0]),
        )
    farthest = float(np.abs(points).max(initial=0.0))
    if farthest > LARGEST_COORDINATE:
        raise PalpateError(
            "{what}: its coordinates reach {farthest:.3g} m; check the unit and the scale",
            what=what,
            farthest=farthest,
        )
