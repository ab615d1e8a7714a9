"""What an elimination costs, counted before it starts: arithmetic, memory, weights of progress."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from ..ordering.symbolic import Front
from .upper_tiles import tile_edges

# Seconds of an operation relative to one in a large matrix product, measured. Triangular solves and
# Cholesky on a front's pivots run slower than products; numbers that are only moved cost time too,
# and so does every front, whatever its size.
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
        """The work of a front."""
        return cls(
            3 * front.pivot_count,
            3 * len(front.boundary),
            3 * front.load_count,
            3 * (front.pivot_count - front.first_loaded),
        )

    @property
    def cholesky_flops(self) -> float:
        """Of the pivots' Cholesky factor."""
        return self.pivots**3 / 3

    @property
    def solve_flops(self) -> float:
        """Of triangular solves: coupling to the boundary, and W."""
        return float(self.pivots**2 * self.boundary + self.loaded_rows**2 * self.loads)

    @property
    def product_flops(self) -> float:
        """Of what is subtracted on the boundary: Schur complement, and loads."""
        return float(
            self.pivots * self.boundary**2 + 2 * self.loaded_rows * self.boundary * self.loads
        )

    @property
    def flops(self) -> float:
        """Of the whole front."""
        return self.cholesky_flops + self.solve_flops + self.product_flops

    @property
    def gram_flops(self) -> float:
        """Of this front's share of W^T W, by its symmetry half of the full product."""
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
        """Held only while the front is worked on."""
        trailing = self.loaded_rows if self.loaded_rows < self.pivots else 0
        return REAL_BYTES * (
            self.pivots * (self.pivots + self.boundary) + trailing * (trailing + self.boundary)
        )

    @property
    def remainder_bytes(self) -> int:
        """Held until the parent has added it."""
        return REAL_BYTES * (upper_tiles_size(self.boundary) + self.boundary * self.loads)

    @property
    def result_bytes(self) -> int:
        """Of this front's rows of W."""
        return REAL_BYTES * self.loaded_rows * self.loads


def upper_tiles_size(size: int) -> int:
    """Numbers that the upper tiles of a (size, size) matrix hold."""
    edges = tile_edges(size)
    return sum(stop * (stop - start) for start, stop in pairwise(edges))


def elimination_peak_bytes(fronts: tuple[Front, ...]) -> tuple[int, int]:
    """The most bytes held at once while fronts are eliminated, and the bytes of W at the end."""
    works = [FrontWork.of(front) for front in fronts]
    # W has its room from the beginning.
    factor = held = peak = sum(work.result_bytes for work in works)
    for front, work in zip(fronts, works, strict=True):
        held += work.factor_bytes + work.remainder_bytes
        peak = max(peak, held)
        held -= work.factor_bytes + sum(works[child].remainder_bytes for child in front.children)
    return peak, factor


class Meter:
    """Turns work done into the share done, for a caller's progress."""

    def __init__(self, total: float, progress: Callable[[float], None]) -> None:
        self._total = total
        self._progress = progress
        self._done = 0.0

    def add(self, work: float) -> None:
        """Count work as done, in operations of a large product; the caller may raise to cancel."""
        self._done += work
        self._progress(min(self._done / self._total, 1.0))
