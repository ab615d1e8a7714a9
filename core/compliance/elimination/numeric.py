"""Numeric step: Cholesky of every front, together with the unit loads of the surface.

For a front with pivots p, boundary b and loads E, in Fortran order and upper halves:

    [ A_pp  A_pb  E_p ]      R_pp = chol(A_pp)                           not kept
    [       A_bb  E_b ]  ->  R_pb = R_pp^-T A_pb                         not kept
                             W_p  = R_pp^-T E_p                          the result
                             A_bb - R_pb^T R_pb,  E_b - R_pb^T W_p       added to the parent

Loads come from the front's children or act on its pivots; W has no entries for other loads.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dgemm, dtrsm
from scipy.linalg.lapack import dpotrf

from ...machine.blas_threads import threads_by_work
from ..free_body.carried_loads import CarriedLoads
from ..ordering.symbolic import Front, SymbolicFactor
from .block_matrix import BlockMatrix
from .extend_add import extend_add, runs_between
from .loose_body import refuse_loose
from .upper_tiles import UpperTiles
from .work import CHOLESKY_WEIGHT, FRONT_WEIGHT, MOVE_WEIGHT, SOLVE_WEIGHT, FrontWork, Meter

# Floating point operations in one call of BLAS at most: some hundredths of a second.
FLOPS_PER_CALL = 2e9

AXES = np.arange(3)


@dataclass(frozen=True, eq=False)
class LoadRows:
    """One front's rows of W = C^-1 E.

    Attributes
    ----------
    start, stop : load freedoms of the columns, in order of elimination.
    rows : float64 (r, stop - start), Fortran order.
    """

    start: int
    stop: int
    rows: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Update:
    """Update of a front's boundary: Schur complement (b, b) and loads (b, c)."""

    schur: UpperTiles
    loads: NDArray[np.float64]


def inverse_factor(
    matrix: BlockMatrix,
    symbolic: SymbolicFactor,
    meter: Meter,
    carried: CarriedLoads | None = None,
) -> list[LoadRows]:
    """W for unit loads on the loaded nodes: W^T W is the inverse at those nodes.

    Loads on all nodes are ``carried`` through beside them.

    Raises
    ------
    PalpateError
        A matrix that is not positive definite: the body is not held.
    """
    entries = EntriesByFront(matrix.rows, matrix.columns, symbolic)
    blocks = entries.in_order(matrix.blocks)
    works = [FrontWork.of(front) for front in symbolic.fronts]
    # One allocation for all rows, to avoid fragmentation by the fronts' temporary arrays.
    room = np.zeros(sum(work.loaded_rows * work.loads for work in works))
    updates: dict[int, _Update] = {}
    result, used = [], 0
    with threads_by_work() as suit:
        for index, (front, work) in enumerate(zip(symbolic.fronts, works, strict=True)):
            suit(work.flops)
            shape = work.loaded_rows, work.loads
            own = room[used : used + shape[0] * shape[1]].reshape(shape, order="F")
            used += own.size
            updates[index] = _eliminated(
                index, entries, blocks, symbolic, updates, own, meter, carried
            )
            if own.size:
                result.append(LoadRows(3 * front.load_start, 3 * front.load_stop, own))
    return result


def _eliminated(
    index: int,
    entries: EntriesByFront,
    blocks: NDArray[np.float64],
    symbolic: SymbolicFactor,
    updates: dict[int, _Update],
    own: NDArray[np.float64],
    meter: Meter,
    carried: CarriedLoads | None,
) -> _Update:
    """Eliminate a front; its rows of W are written to ``own``, zeros before."""
    front = symbolic.fronts[index]
    work = FrontWork.of(front)
    pivots = np.zeros((work.pivots, work.pivots), order="F")
    border = np.zeros((work.pivots, work.boundary), order="F")
    schur = UpperTiles.zeros(work.boundary)
    skipped = work.pivots - work.loaded_rows
    passed = np.zeros((work.boundary, work.loads), order="F")

    entries.add_to(index, front, blocks, pivots, border)
    stiffness = pivots.diagonal().copy()
    loaded = (3 * front.loaded_pivots[:, None] + AXES).ravel()
    own[loaded - skipped, np.arange(work.loads - len(loaded), work.loads)] = 1.0
    for child in front.children:
        below, update = symbolic.fronts[child], updates.pop(child)
        runs = runs_between(
            targets_of_child(below, front), work.pivots, update.schur.edges, schur.edges
        )
        extend_add(update.schur, runs, pivots, border, schur)
        meter.add(MOVE_WEIGHT * update.schur.size)
        if not below.load_count:
            # Without loads from below, W may omit the pivots before the first loaded one.
            continue
        first = 3 * (below.load_start - front.load_start)
        columns = slice(first, first + update.loads.shape[1])
        for run in runs:
            target = own if run.parent_tile < 0 else passed
            part = update.loads[run.below]
            target[run.onward, columns] = part
            meter.add(MOVE_WEIGHT * part.size)
    meter.add(FRONT_WEIGHT)

    factor, breakdown = dpotrf(pivots, lower=False, clean=False, overwrite_a=True)
    refuse_loose(breakdown, factor.diagonal() ** 2, stiffness)
    meter.add(CHOLESKY_WEIGHT * work.cholesky_flops)
    _solve_transposed(factor, border, meter)
    schur.subtract_gram(border, meter.add)
    if carried is not None:
        carried.eliminate(front, factor, border)
    if skipped:
        factor = np.asfortranarray(factor[skipped:, skipped:])
        border = np.asfortranarray(border[skipped:])
    _solve_transposed(factor, own, meter)
    if carried is not None:
        carried.meet(front, own)
    _subtract_product(border, own, passed, meter)
    return _Update(schur, passed)


def targets_of_child(child: Front, parent: Front) -> NDArray[np.int64]:
    """Parent's freedom, pivots first, of each freedom of the child's boundary."""
    nodes = np.where(
        child.boundary < parent.stop,
        child.boundary - parent.start,
        parent.pivot_count + np.searchsorted(parent.boundary, child.boundary),
    )
    return (3 * nodes[:, None] + AXES).ravel()


def _solve_transposed(
    factor: NDArray[np.float64], right: NDArray[np.float64], meter: Meter
) -> None:
    """Replace ``right`` (p, m) by R^-T right, R the upper half of ``factor`` (p, p)."""
    size = len(factor)
    for columns in _short_calls(right.shape[1], size**2):
        part = right[:, columns]
        dtrsm(1.0, factor, part, trans_a=True, overwrite_b=True)
        meter.add(SOLVE_WEIGHT * size**2 * part.shape[1])


def _subtract_product(
    border: NDArray[np.float64],
    own: NDArray[np.float64],
    passed: NDArray[np.float64],
    meter: Meter,
) -> None:
    """Subtract ``border.T @ own`` from ``passed`` (b, c)."""
    if not border.size:
        return
    for columns in _short_calls(own.shape[1], 2 * border.size):
        dgemm(
            -1.0, border, own[:, columns], 1.0, passed[:, columns], trans_a=True, overwrite_c=True
        )
        meter.add(2.0 * border.size * own[:, columns].shape[1])


def _short_calls(columns: int, flops_per_column: int) -> list[slice]:
    """Parts of the columns that take one short call each."""
    if not flops_per_column:
        return []
    step = max(int(FLOPS_PER_CALL / flops_per_column), 16)
    return [slice(start, min(start + step, columns)) for start in range(0, columns, step)]


class EntriesByFront:
    """Places of a block matrix's upper half in the fronts.

    ``rows`` and ``columns`` (m,) of the blocks, both halves of the matrix.
    """

    def __init__(
        self, rows: NDArray[np.int64], columns: NDArray[np.int64], symbolic: SymbolicFactor
    ) -> None:
        rows, columns = symbolic.place[rows], symbolic.place[columns]
        upper = np.flatnonzero(rows <= columns)
        self._upper = upper[np.argsort(rows[upper], kind="stable")]
        self._rows, self._columns = rows[self._upper], columns[self._upper]
        stops = [0] + [front.stop for front in symbolic.fronts]
        self._bounds = np.searchsorted(self._rows, stops)

    def in_order(self, blocks: NDArray[np.float64]) -> NDArray[np.float64]:
        """Blocks of the upper half, sorted for :meth:`add_to`."""
        return blocks[self._upper]

    def add_to(
        self,
        index: int,
        front: Front,
        blocks: NDArray[np.float64],
        pivots: NDArray[np.float64],
        border: NDArray[np.float64],
    ) -> None:
        """Write the entries of front ``index`` of sorted ``blocks`` into empty arrays."""
        span = slice(*self._bounds[index : index + 2])
        rows, columns, blocks = self._rows[span], self._columns[span], blocks[span]
        inside = columns < front.stop
        for chosen, target, places in (
            (inside, pivots, columns - front.start),
            (~inside, border, np.searchsorted(front.boundary, columns)),
        ):
            row = 3 * (rows[chosen] - front.start)[:, None, None] + AXES[:, None]
            column = 3 * places[chosen][:, None, None] + AXES
            target[row, column] = blocks[chosen]
