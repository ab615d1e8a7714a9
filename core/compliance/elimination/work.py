"""Cost of an elimination, counted in advance: arithmetic, memory, weights of progress."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from ..ordering.symbolic import Front
from .upper_tiles import tile_edges

# Time relative to an operation in a large matrix product, measured, of one operation in triangular
# solves and in Cholesky on pivots, of a number moved, and of a front of any size.
SOLVE_WEIGHT = 1.6
CHOLESKY_WEIGHT = 3.0
MOVE_WEIGHT = 250.0
FRONT_WEIGHT = 1.5e7

REAL_BYTES = 8


@dataclass(frozen=True)
class FrontWork:
    """Floating point operations and sizes of one front, in freedoms.

    Attributes
    ----------
    pivots, boundary, loads : how many.
    loaded_rows : pivots that any load reaches; rows of W.
    """

    pivots: int
    boundary: int
    loads: int
    loaded_rows: int

    @classmethod
    def of(cls, front: Front) -> FrontWork:
        """Work of a front."""
        return cls(
            3 * front.pivot_count,
            3 * len(front.boundary),
            3 * front.load_count,
            3 * (front.pivot_count - front.first_loaded),
        )

    @property
    def cholesky_flops(self) -> float:
        """Operations of the pivots' Cholesky factor."""
        return self.pivots**3 / 3

    @property
    def solve_flops(self) -> float:
        """Operations of triangular solves: border, and W."""
        return float(self.pivots**2 * self.boundary + self.loaded_rows**2 * self.loads)

    @property
    def product_flops(self) -> float:
        """Operations of the update of the boundary: Schur complement, and loads."""
        return float(
            self.pivots * self.boundary**2 + 2 * self.loaded_rows * self.boundary * self.loads
        )

    @property
    def flops(self) -> float:
        """Operations of the front."""
        return self.cholesky_flops + self.solve_flops + self.product_flops

    @property
    def gram_flops(self) -> float:
        """Operations of this front's share of W^T W: by symmetry half of the full product."""
        return float(self.loaded_rows * self.loads**2)

    @property
    def weight(self) -> float:
        """Time of the elimination, in operations of a large product."""
        return (
            CHOLESKY_WEIGHT * self.cholesky_flops
            + SOLVE_WEIGHT * self.solve_flops
            + self.product_flops
            + FRONT_WEIGHT
            + MOVE_WEIGHT * (upper_tiles_size(self.boundary) + self.boundary * self.loads)
        )

    @property
    def factor_bytes(self) -> int:
        """Bytes held while the front is eliminated."""
        trailing = self.loaded_rows if self.loaded_rows < self.pivots else 0
        return REAL_BYTES * (
            self.pivots * (self.pivots + self.boundary) + trailing * (trailing + self.boundary)
        )

    @property
    def update_bytes(self) -> int:
        """Bytes held until the parent has added the update."""
        return REAL_BYTES * (upper_tiles_size(self.boundary) + self.boundary * self.loads)

    @property
    def result_bytes(self) -> int:
        """Bytes of this front's rows of W."""
        return REAL_BYTES * self.loaded_rows * self.loads


def upper_tiles_size(size: int) -> int:
    """Numbers held by the upper tiles of a (size, size) matrix."""
    edges = tile_edges(size)
    return sum(stop * (stop - start) for start, stop in pairwise(edges))


def elimination_peak_bytes(fronts: tuple[Front, ...]) -> tuple[int, int]:
    """Peak bytes while fronts are eliminated, and the bytes of W at the end."""
    works = [FrontWork.of(front) for front in fronts]
    # W is allocated from the beginning.
    factor = held = peak = sum(work.result_bytes for work in works)
    for front, work in zip(fronts, works, strict=True):
        held += work.factor_bytes + work.update_bytes
        peak = max(peak, held)
        held -= work.factor_bytes + sum(works[child].update_bytes for child in front.children)
    return peak, factor


class Meter:
    """Converts work done to a share, for a progress callback."""

    def __init__(self, total: float, progress: Callable[[float], None]) -> None:
        self._total = total
        self._progress = progress
        self._done = 0.0

    def add(self, work: float) -> None:
        """Count work done, in operations of a large product; the callback may raise to cancel."""
        self._done += work
        self._progress(min(self._done / self._total, 1.0))
