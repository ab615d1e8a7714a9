"""Cholesky factors kept for solves, of many matrices of one pattern.

Order of elimination and indices are computed once; each further matrix costs arithmetic only. The
fronts are those of :mod:`.numeric`, without loads.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dtrsm, dtrsv
from scipy.linalg.lapack import dpotrf

from ...machine.blas_threads import threads_by_work
from ...stiffness.freedoms import freedoms
from ..ordering.dissection import dissect
from ..ordering.symbolic import Front, SymbolicFactor, analyse
from .block_matrix import BlockMatrix
from .extend_add import Run, extend_add, runs_between, targets_of_child
from .numeric import EntriesByFront
from .upper_tiles import UpperTiles, tile_edges
from .work import FrontWork

# The freedoms in order of elimination; of each front its size and how many others it reaches;
# these, as places in the order; of each front the rows, from the diagonal, there the inverse, over
# its own and these.
FlatFactor: TypeAlias = tuple[
    NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.floating]
]


class NotPositiveDefiniteError(Exception):
    """Matrix without Cholesky factor. The caller says what this means for the body."""


@dataclass(frozen=True, eq=False)
class CholeskyFactor:
    """R with ``R^T R`` the factored matrix, by fronts.

    Attributes
    ----------
    order : int64 (3n,), the freedoms in order of elimination.
    fronts : each front's part of R, in order.
    """

    order: NDArray[np.int64]
    fronts: tuple[_FrontFactor, ...]

    @property
    def nbytes(self) -> int:
        """Bytes of the factor."""
        return sum(front.pivots.nbytes + front.border.nbytes for front in self.fronts)

    def flat(self, precision: type[np.floating], every: int = 1) -> FlatFactor:
        """R as one array, for the native code.

        ``every`` 3 takes one of three freedoms, where the matrix has the same number for each axis.
        """
        order, boundaries, sizes, reaches, entries = self.order[::every] // every, [], [], [], []
        for front in self.fronts:
            pivots, border = front.pivots[::every, ::every], front.border[::every, ::every]
            rows = np.hstack([pivots, border])
            np.fill_diagonal(rows, 1.0 / np.diagonal(rows))
            entries.append(rows[np.triu_indices(len(rows), 0, rows.shape[1])].astype(precision))
            sizes.append(len(pivots))
            reaches.append(border.shape[1])
            boundaries.append(front.boundary[::every] // every)
        return (
            order,
            np.array(sizes),
            np.array(reaches),
            np.concatenate(boundaries),
            np.concatenate(entries),
        )

    def solve(self, right: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solution for right-hand sides (3n,) or (3n, k), of the same shape; thread-safe."""
        if right.size == len(self.order):
            return self._solve_one(right.ravel()).reshape(right.shape)
        columns = right.reshape(len(self.order), -1)
        held = np.asfortranarray(columns[self.order], dtype=np.float64)
        for front in self.fronts:
            own = dtrsm(1.0, front.pivots, held[front.span], trans_a=True, overwrite_b=True)
            held[front.span] = own
            if front.boundary.size:
                held[front.boundary] -= front.border.T @ own
        for front in reversed(self.fronts):
            own = held[front.span]
            if front.boundary.size:
                own = own - front.border @ held[front.boundary]
            held[front.span] = dtrsm(1.0, front.pivots, own)
        solution = np.empty_like(held)
        solution[self.order] = held
        return solution.reshape(right.shape)

    def _solve_one(self, right: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solution for one right-hand side, without the copies that the solve for many makes."""
        held: NDArray[np.float64] = right[self.order].astype(np.float64, copy=False)
        for front in self.fronts:
            own = dtrsv(front.pivots, held[front.span], trans=1)
            held[front.span] = own
            if front.boundary.size:
                held[front.boundary] -= own @ front.border
        for front in reversed(self.fronts):
            own = held[front.span]
            if front.boundary.size:
                own = own - front.border @ held[front.boundary]
            held[front.span] = dtrsv(front.pivots, own)
        solution = np.empty_like(held)
        solution[self.order] = held
        return solution


@dataclass(frozen=True, eq=False)
class _FrontFactor:
    """Rows of R: upper (p, p) of the pivots, (p, b) of the border, and their places."""

    span: slice
    boundary: NDArray[np.int64]
    pivots: NDArray[np.float64]
    border: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RepeatedElimination:
    """Symbolic factorization of symmetric matrices of one pattern of 3x3 blocks.

    Attributes
    ----------
    symbolic : order of elimination and fronts.
    entries : destination of each block.
    runs : for every front and each of its children, where the child's Schur complement is added.
    """

    symbolic: SymbolicFactor
    entries: EntriesByFront
    runs: tuple[tuple[list[Run], ...], ...]

    @classmethod
    def of(
        cls,
        rows: NDArray[np.int64],
        columns: NDArray[np.int64],
        positions: NDArray[np.float64],
    ) -> RepeatedElimination:
        """Factorization for blocks at ``rows``, ``columns`` (m,), in both halves of the matrix.

        ``positions`` (n, 3) of the nodes: see :func:`.dissection.dissect`.
        """
        count = len(positions)
        unloaded = np.zeros(count, dtype=bool)
        pattern = BlockMatrix(count, rows, columns, np.empty((0, 3, 3)))
        edges = pattern.edges
        symbolic = analyse(dissect(edges, positions, unloaded), edges, unloaded)
        runs = tuple(
            tuple(_runs(symbolic.fronts[child], front) for child in front.children)
            for front in symbolic.fronts
        )
        return cls(symbolic, EntriesByFront(rows, columns, symbolic), runs)

    def factor(self, blocks: NDArray[np.float64]) -> CholeskyFactor:
        """Factor the matrix of ``blocks`` (m, 3, 3), in the order of the pattern.

        Raises
        ------
        NotPositiveDefiniteError
            The matrix has a negative or vanishing eigenvalue.
        """
        updates: dict[int, UpperTiles] = {}
        factors = []
        with threads_by_work() as suit:
            for index, front in enumerate(self.symbolic.fronts):
                work = FrontWork.of(front)
                suit(work.flops)
                own, updates[index] = self._eliminated(index, blocks, updates)
                factors.append(own)
        return CholeskyFactor(freedoms(self.symbolic.order), tuple(factors))

    def _eliminated(
        self, index: int, blocks: NDArray[np.float64], updates: dict[int, UpperTiles]
    ) -> tuple[_FrontFactor, UpperTiles]:
        front = self.symbolic.fronts[index]
        size, boundary = 3 * front.pivot_count, freedoms(front.boundary)
        pivots = np.zeros((size, size), order="F")
        border = np.zeros((size, len(boundary)), order="F")
        schur = UpperTiles(len(boundary))
        self.entries.add_to(index, front, blocks, pivots, border)
        children = [updates.pop(child) for child in front.children]
        extend_add(list(zip(children, self.runs[index], strict=True)), pivots, border, schur)
        factor, breakdown = dpotrf(pivots, lower=False, clean=False, overwrite_a=True)
        if breakdown:
            raise NotPositiveDefiniteError
        dtrsm(1.0, factor, border, trans_a=True, overwrite_b=True)
        schur.subtract_gram(border, _unmetered)
        own = _FrontFactor(slice(3 * front.start, 3 * front.stop), boundary, factor, border)
        return own, schur


def _runs(child: Front, front: Front) -> list[Run]:
    own, parent = (tile_edges(3 * len(each.boundary)) for each in (child, front))
    return runs_between(targets_of_child(child, front), 3 * front.pivot_count, own, parent)


def _unmetered(_: float) -> None:
    """Progress callback that does nothing: such a factor takes seconds at most."""
