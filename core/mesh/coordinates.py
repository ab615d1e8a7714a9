"""Usable coordinates, the box of size one for what depends on size, and an order in space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError

# Far beyond any prop, in any unit; products of much larger numbers may overflow.
LARGEST_COORDINATE = 1e15

# Steps between neighbouring coordinates at most, as a share of the size: coarser ones have taken
# the detail that the usual tolerance keeps.
LARGEST_STEP = 1e-3

# Steps of coordinates in a box of size one. A change of unit moves their last bits, which a mesher
# may answer with other tetrahedra; it is given the same numbers in every unit.
STEPS_OF_ONE = 2.0**32

# Cells of the space-filling curve along each axis of the bounding box: 2 to this power.
Z_CURVE_BITS = 12


@dataclass(frozen=True, eq=False)
class UnitBox:
    """Map to coordinates in which a shape has its middle at 0 and a diagonal of 1.

    Attributes
    ----------
    middle : float64 (3,), of the shape's bounding box, metres.
    diagonal : of this box, metres.
    """

    middle: NDArray[np.float64]
    diagonal: float

    @classmethod
    def of(cls, points: NDArray[np.float64]) -> UnitBox:
        """The box of ``points`` (p, 3)."""
        low, high = points.min(axis=0), points.max(axis=0)
        return cls(low + 0.5 * (high - low), float(np.linalg.norm(high - low)))

    def enter(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """``points`` (p, 3), metres, in the box, on its steps."""
        within: NDArray[np.float64] = (points - self.middle) / self.diagonal
        # No -0.0: it is the same place.
        return np.round(within * STEPS_OF_ONE) / STEPS_OF_ONE + 0.0

    def leave(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """``points`` (p, 3) of the box in metres."""
        return self.diagonal * points + self.middle


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


def refuse_rounded(what: str, points: NDArray[Any]) -> None:
    """Check that ``points`` (p, 3) of ``what``, in any unit, lie near enough to the origin for the
    precision of their numbers, which is that of the array's type.

    Raises
    ------
    PalpateError
        The steps of their coordinates are coarse beside the shape.
    """
    if points.dtype.kind != "f" or points.ndim != 2 or not points.size:
        return
    farthest = np.abs(points).max()
    # What is not finite, out of range or without size is refused as such.
    if not farthest <= LARGEST_COORDINATE:
        return
    size = float(np.linalg.norm(np.ptp(points.astype(np.float64), axis=0)))
    step = float(np.spacing(farthest))
    if step > LARGEST_STEP * size > 0.0:
        raise PalpateError(
            "{what}: it lies {times:.2g} times its size from the origin, where coordinates are "
            "rounded to {share:.2g} % of its size, so that detail is lost; model it at the origin, "
            "or move it there (in Blender: Set Origin > Origin to Geometry) and check its shape",
            what=what,
            times=float(farthest) / size,
            share=100 * step / size,
        )


def along_z_curve(positions: NDArray[np.float64]) -> NDArray[np.int64]:
    """Places (n, 3) ordered by interleaving the bits of their coordinates (Morton's order), (n,).

    Those near each other in space are mostly near each other in this order.
    """
    extent = np.ptp(positions, axis=0).max()
    steps = (1 << Z_CURVE_BITS) - 1
    cells = ((positions - positions.min(axis=0)) * (steps / (extent or 1.0))).astype(np.int64)
    code = np.zeros(len(positions), dtype=np.int64)
    for bit in range(Z_CURVE_BITS):
        for axis in range(3):
            code |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")
