"""L = W^T W, tile by tile into the table of the compliance."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dgemm, dsyrk

from ...machine.blas_threads import threads_by_work
from ...stiffness.freedoms import freedoms
from ..free_body.rigid_part import RigidPart
from .numeric import LoadRows
from .upper_tiles import tile_edges
from .work import MOVE_WEIGHT, REAL_BYTES, FrontWork, Meter

# Rows and columns of L computed at once.
TILE = 768

# Rows of the table whose columns are reordered at once.
ROWS_RENUMBERED = 96


def inverse_table(
    factor: Sequence[LoadRows],
    ranks: NDArray[np.int64],
    dtype: type[np.floating],
    meter: Meter,
    rigid: RigidPart | None = None,
) -> NDArray[np.floating]:
    """Inverse at the loaded nodes, (n, 3, 3n), exactly symmetric.

    Parameters
    ----------
    factor : from :func:`palpate.core.compliance.elimination.numeric.inverse_factor`.
    ranks : int64 (n,), for each loaded node in order of elimination, its place in the table.
    dtype : of the table; the sums are float64.
    rigid : of a free body, taken away; in order of elimination.
    """
    count = 3 * len(ranks)
    # Loads that meet in no front have no interaction: entries stay zero.
    table = np.zeros((count, count), dtype=dtype)
    edges = tile_edges(count, TILE)
    tiles = [slice(start, stop) for start, stop in pairwise(edges)]
    with threads_by_work() as suit:
        for index, columns in enumerate(tiles):
            for rows in tiles[: index + 1]:
                block = _tile(factor, rows, columns, suit, meter, rigid)
                table[rows, columns] = block
                table[columns, rows] = table[rows, columns].T
    _renumber(table, ranks, meter)
    return table.reshape(len(ranks), 3, count)


def _renumber(table: NDArray[np.floating], ranks: NDArray[np.int64], meter: Meter) -> None:
    """Move row and column of each node i to place ``ranks[i]``, without a second table."""
    nodes = len(ranks)
    order = np.argsort(ranks)
    columns = freedoms(order)
    for start in range(0, len(table), ROWS_RENUMBERED):
        rows = slice(start, start + ROWS_RENUMBERED)
        table[rows] = np.take(table[rows], columns, axis=1)
        meter.add(MOVE_WEIGHT * table[rows].size)
    by_node = table.reshape(nodes, -1)
    pending = np.ones(nodes, dtype=bool)
    for first in range(nodes):
        if not pending[first] or order[first] == first:
            continue
        # Along one cycle of the permutation: each row moves to the place just vacated.
        waiting, place = by_node[first].copy(), first
        while (source := int(order[place])) != first:
            by_node[place] = by_node[source]
            pending[place] = False
            place = source
        by_node[place] = waiting
        pending[place] = False


def inverse_weight(works: Iterable[FrontWork], node_count: int) -> float:
    """Time of :func:`inverse_table` for n loaded nodes, in operations of a large product."""
    return sum(work.gram_flops for work in works) + MOVE_WEIGHT * (3 * node_count) ** 2


def inverse_bytes(node_count: int, itemsize: int) -> int:
    """Peak bytes of :func:`inverse_table` besides W, for n loaded nodes."""
    if not itemsize:
        return 0
    tile = min(3 * node_count, TILE) ** 2
    # A tile, its copy while it is mirrored or added, and the indices.
    return (3 * node_count) ** 2 * itemsize + 3 * tile * REAL_BYTES


def _tile(
    factor: Sequence[LoadRows],
    rows: slice,
    columns: slice,
    suit: Callable[[float], None],
    meter: Meter,
    rigid: RigidPart | None,
) -> NDArray[np.float64]:
    """Tile of W^T W less the rigid part, both halves also on the diagonal."""
    block = np.zeros((rows.stop - rows.start, columns.stop - columns.start), order="F")
    for part in factor:
        left, right = _meeting(part, rows), _meeting(part, columns)
        if left.start < left.stop and right.start < right.stop:
            half = float(len(part.rows) * (left.stop - left.start) * (right.stop - right.start))
            flops = half if rows == columns else 2.0 * half
            suit(flops)
            corner = (left.start - rows.start, right.start - columns.start)
            _add_gram(part, left, right, block, corner)
            meter.add(flops)
    if rigid is not None:
        block -= rigid.at(rows).against(rigid.at(columns))
    if rows == columns:
        block = np.triu(block)
        block += np.triu(block, 1).T
    return block


def _meeting(part: LoadRows, span: slice) -> slice:
    """Freedoms of a span on which a part has loads; empty if start >= stop."""
    return slice(max(part.start, span.start), min(part.stop, span.stop))


def _add_gram(
    part: LoadRows,
    left: slice,
    right: slice,
    block: NDArray[np.float64],
    corner: tuple[int, int],
) -> None:
    """Add W_left^T W_right to a block, at its ``corner``; its upper half if left is right."""
    first = part.rows[:, left.start - part.start : left.stop - part.start]
    second = part.rows[:, right.start - part.start : right.stop - part.start]
    height, width = first.shape[1], second.shape[1]
    if (height, width) == block.shape:
        if left == right:
            dsyrk(1.0, first, 1.0, block, trans=True, overwrite_c=True)
        else:
            dgemm(1.0, first, second, 1.0, block, trans_a=True, overwrite_c=True)
        return
    target = block[corner[0] : corner[0] + height, corner[1] : corner[1] + width]
    if left == right:
        target += dsyrk(1.0, first, trans=True)
    else:
        target += dgemm(1.0, first, second, trans_a=True)
