"""Numeric step: Cholesky of every front, together with the unit loads of the surface.

For a front with pivots p, boundary b and loads E, in Fortran order and upper halves:

    [ A_pp  A_pb  E_p ]      R_pp = chol(A_pp)                           not kept
    [       A_bb  E_b ]  ->  R_pb = R_pp^-T A_pb                         not kept
                             W_p  = R_pp^-T E_p                          the result
                             A_bb - R_pb^T R_pb,  E_b - R_pb^T W_p       added to the parent

Loads come from the front's children or act on its pivots; W has no entries for other loads.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dgemm, dtrsm
from scipy.linalg.lapack import dpotrf

from ...machine.available_memory import zeros_apart
from ...machine.blas_threads import threads_by_work
from ..free_body.carried_loads import CarriedLoads
from ..ordering.symbolic import Front, SymbolicFactor
from .block_matrix import BlockMatrix
from .extend_add import AXES, extend_add, runs_between, targets_of_child
from .loose_body import refuse_loose
from .passed_loads import Panel, arriving, panel_edges
from .upper_tiles import UpperTiles
from .work import CHOLESKY_WEIGHT, FRONT_WEIGHT, MOVE_WEIGHT, SOLVE_WEIGHT, FrontWork, Meter

# Floating point operations in one call of BLAS at most: some hundredths of a second.
FLOPS_PER_CALL = 2e9


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
    """Update of a front's boundary: Schur complement (b, b) and loads (b, c), in panels."""

    schur: UpperTiles
    loads: list[Panel]


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
    edges = panel_edges(symbolic.fronts)
    works = [FrontWork.of(front) for front in symbolic.fronts]
    updates: dict[int, _Update] = {}
    result = []
    with threads_by_work() as suit:
        for index, (front, work) in enumerate(zip(symbolic.fronts, works, strict=True)):
            suit(work.flops)
            own = zeros_apart((work.loaded_rows, work.loads))
            children = [(symbolic.fronts[child], updates.pop(child)) for child in front.children]
            enter = partial(entries.add_to, index, front, matrix.blocks)
            updates[index] = _eliminated(front, edges[index], enter, children, own, meter, carried)
            if own.size:
                result.append(LoadRows(3 * front.load_start, 3 * front.load_stop, own))
    return result


def _eliminated(
    front: Front,
    edges: tuple[int, ...],
    enter: Callable[[NDArray[np.float64], NDArray[np.float64]], None],
    children: list[tuple[Front, _Update]],
    own: NDArray[np.float64],
    meter: Meter,
    carried: CarriedLoads | None,
) -> _Update:
    """Eliminate a front; its rows of W are written to ``own``, zeros before.

    ``enter`` writes the matrix's entries to pivots and border. Of the children's updates nothing is
    left.
    """
    work = FrontWork.of(front)
    pivots = zeros_apart((work.pivots, work.pivots))
    border = zeros_apart((work.pivots, work.boundary))
    enter(pivots, border)
    stiffness = pivots.diagonal().copy()
    schur = UpperTiles(work.boundary)
    placed = [
        (
            update,
            runs_between(
                targets_of_child(child, front), work.pivots, update.schur.edges, schur.edges
            ),
        )
        for child, update in children
    ]
    for update, _ in placed:
        meter.add(MOVE_WEIGHT * update.schur.size)
    extend_add([(update.schur, runs) for update, runs in placed], pivots, border, schur)
    meter.add(FRONT_WEIGHT)

    factor, breakdown = dpotrf(pivots, lower=False, clean=False, overwrite_a=True)
    del pivots
    refuse_loose(breakdown, factor.diagonal() ** 2, stiffness)
    meter.add(CHOLESKY_WEIGHT * work.cholesky_flops)
    _solve_transposed(factor, border, meter)
    schur.subtract_gram(border, meter.add)
    if carried is not None:
        carried.eliminate(front, factor, border)
    skipped = work.pivots - work.loaded_rows
    if skipped:
        factor = np.asfortranarray(factor[skipped:, skipped:])
        border = np.asfortranarray(border[skipped:])
    loaded = (3 * front.loaded_pivots[:, None] + AXES).ravel()
    own[loaded - skipped, np.arange(work.loads - len(loaded), work.loads)] = 1.0
    loads = []
    panels = [(update.loads, runs) for update, runs in placed]
    for panel in arriving(front, edges, panels, own, work.boundary):
        moved = own[:, panel.start - edges[0] : panel.stop - edges[0]]
        _solve_transposed(factor, moved, meter)
        _subtract_product(border, moved, panel.rows, meter)
        meter.add(MOVE_WEIGHT * panel.rows.size)
        if work.boundary:
            loads.append(panel)
    if carried is not None:
        carried.meet(front, own)
    return _Update(schur, loads)


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

    ``rows`` and ``columns`` (m,) of the blocks; of those below the diagonal in order of elimination
    no use is made.
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

    def add_to(
        self,
        index: int,
        front: Front,
        blocks: NDArray[np.float64],
        pivots: NDArray[np.float64],
        border: NDArray[np.float64],
    ) -> None:
        """Write the entries of front ``index`` of the ``blocks`` (m, 3, 3) into empty arrays."""
        span = slice(*self._bounds[index : index + 2])
        rows, columns, blocks = self._rows[span], self._columns[span], blocks[self._upper[span]]
        inside = columns < front.stop
        for chosen, target, places in (
            (inside, pivots, columns - front.start),
            (~inside, border, np.searchsorted(front.boundary, columns)),
        ):
            row = 3 * (rows[chosen] - front.start)[:, None, None] + AXES[:, None]
            column = 3 * places[chosen][:, None, None] + AXES
            target[row, column] = blocks[chosen]
