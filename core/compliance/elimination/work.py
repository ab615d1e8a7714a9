"""Cost of an elimination, counted in advance: arithmetic, memory, weights of progress."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..ordering.symbolic import Front
from .extend_add import targets_of_child
from .passed_loads import panel_edges
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
        """Bytes of pivots and border, held while the front is eliminated."""
        return REAL_BYTES * self.pivots * (self.pivots + self.boundary)

    @property
    def trailing_bytes(self) -> int:
        """Bytes of what of these loads reach, taken apart where they do not reach all."""
        trailing = self.loaded_rows if self.loaded_rows < self.pivots else 0
        return REAL_BYTES * trailing * (trailing + self.boundary)

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


@dataclass(frozen=True)
class FrontMemory:
    """Bytes that a front holds.

    Attributes
    ----------
    needed : at most while it is eliminated, its children's updates and its rows of W included.
    left : of its update, until the parent has taken it.
    kept : of its rows of W.
    """

    needed: int
    left: int
    kept: int


def memory_by_front(fronts: tuple[Front, ...]) -> list[FrontMemory]:
    """Memory of each front's elimination, as :mod:`.numeric` allocates it."""
    works, edges = [FrontWork.of(front) for front in fronts], panel_edges(fronts)
    return [
        FrontMemory(
            works[index].result_bytes
            + max(_while_added(front, fronts, works), _while_passed(index, fronts, works, edges)),
            works[index].update_bytes,
            works[index].result_bytes,
        )
        for index, front in enumerate(fronts)
    ]


def _while_added(front: Front, fronts: tuple[Front, ...], works: list[FrontWork]) -> int:
    """Bytes at most while children's Schur complements become the front's, column by column."""
    own = FrontWork.of(front)
    held = own.factor_bytes + sum(works[child].update_bytes for child in front.children)
    edges, peak = tile_edges(own.boundary), held
    given_up = np.zeros(len(edges), dtype=np.int64)
    for child in front.children:
        below = tile_edges(works[child].boundary)
        if len(below) > 1:
            last = targets_of_child(fronts[child], front)[np.array(below[1:]) - 1]
            # Place 0 are the pivots, which come before all tiles.
            tile = np.searchsorted(edges, last - own.pivots, side="right")
            np.add.at(given_up, tile, _column_bytes(below))
    held -= int(given_up[0])
    for added, removed in zip(_column_bytes(edges), given_up[1:].tolist(), strict=True):
        held += added
        peak = max(peak, held)
        held -= removed
    return peak


def _while_passed(
    index: int,
    fronts: tuple[Front, ...],
    works: list[FrontWork],
    edges: list[tuple[int, ...]],
) -> int:
    """Bytes at most while children's loads become the front's, panel by panel."""
    front, work = fronts[index], works[index]
    held = work.factor_bytes + REAL_BYTES * upper_tiles_size(work.boundary)
    waiting = []
    for child in front.children:
        height = REAL_BYTES * works[child].boundary
        waiting += [(start, height * (stop - start)) for start, stop in pairwise(edges[child])]
    held += sum(size for _, size in waiting)
    peak = held + work.trailing_bytes
    if work.trailing_bytes:
        held += work.trailing_bytes - work.factor_bytes
    for start, stop in pairwise(edges[index]):
        held += REAL_BYTES * work.boundary * (stop - start)
        peak = max(peak, held)
        held -= sum(size for first, size in waiting if start <= first < stop)
    return peak


def _column_bytes(edges: tuple[int, ...]) -> list[int]:
    """Bytes of each block of columns of tiles."""
    return [REAL_BYTES * stop * (stop - start) for start, stop in pairwise(edges)]


def elimination_peak_bytes(fronts: tuple[Front, ...], memory: list[FrontMemory]) -> tuple[int, int]:
    """Peak bytes while fronts are eliminated, and the bytes of W at the end."""
    held = peak = 0
    for front, own in zip(fronts, memory, strict=True):
        held -= sum(memory[child].left for child in front.children)
        peak = max(peak, held + own.needed)
        held += own.left + own.kept
    return peak, sum(own.kept for own in memory)


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
