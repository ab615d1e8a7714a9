"""Extend-add: a front's Schur complement added to its parent's matrix.

Both number nodes in order of elimination, so a child's boundary maps to the parent's in the same
order, in consecutive runs. Runs are added as slices, several times faster than single entries.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..ordering.symbolic import Front
from .upper_tiles import UpperTiles

AXES = np.arange(3)


@dataclass(frozen=True)
class Run:
    """Consecutive freedoms of a child's boundary that stay consecutive in the parent.

    Attributes
    ----------
    child_tile, child : tile of the child's Schur complement, and the freedoms within that tile.
    below : the same freedoms counted along all of the child's boundary.
    parent_tile, parent : tile of the parent's Schur complement and freedoms within it; tile -1 are
        the parent's pivots.
    onward : the freedoms counted along all of the parent's boundary, or among its pivots.
    """

    child_tile: int
    child: slice
    below: slice
    parent_tile: int
    parent: slice
    onward: slice


def targets_of_child(child: Front, parent: Front) -> NDArray[np.int64]:
    """Parent's freedom, pivots first, of each freedom of the child's boundary."""
    nodes = np.where(
        child.boundary < parent.stop,
        child.boundary - parent.start,
        parent.pivot_count + np.searchsorted(parent.boundary, child.boundary),
    )
    return (3 * nodes[:, None] + AXES).ravel()


def runs_between(
    targets: NDArray[np.int64],
    pivot_count: int,
    child_edges: tuple[int, ...],
    parent_edges: tuple[int, ...],
) -> list[Run]:
    """Cut a child's boundary into runs.

    Parameters
    ----------
    targets : (m,), the parent's freedom, pivots first, of each freedom of the child's boundary.
    pivot_count : freedoms of the parent's pivots.
    child_edges, parent_edges : of the tiles of both Schur complements.
    """
    size = len(targets)
    if not size:
        return []
    child_tile = np.searchsorted(child_edges, np.arange(size), side="right") - 1
    parent_tile = np.searchsorted(parent_edges, targets - pivot_count, side="right") - 1
    broken = (np.diff(targets) != 1) | (np.diff(child_tile) != 0) | (np.diff(parent_tile) != 0)
    starts = np.concatenate([[0], np.flatnonzero(broken) + 1])
    stops = np.concatenate([starts[1:], [size]])
    runs = []
    for start, stop in zip(starts.tolist(), stops.tolist(), strict=True):
        source, target = int(child_tile[start]), int(parent_tile[start])
        count, base = stop - start, child_edges[source]
        onward = int(targets[start]) - (pivot_count if target >= 0 else 0)
        within = onward - (parent_edges[target] if target >= 0 else 0)
        runs.append(
            Run(
                source,
                slice(start - base, stop - base),
                slice(start, stop),
                target,
                slice(within, within + count),
                slice(onward, onward + count),
            )
        )
    return runs


def extend_add(
    children: Sequence[tuple[UpperTiles, list[Run]]],
    pivots: NDArray[np.float64],
    border: NDArray[np.float64],
    schur: UpperTiles,
) -> None:
    """Add children's Schur complements to their parent's three parts, in place.

    Columns ascend in all of them alike, so the parent's are made one block after another, and each
    block of a child's is given up as soon as all of it has been added.

    Parameters
    ----------
    children : (m, m) each, and its runs from :func:`runs_between`; of the tiles nothing is left.
    pivots : (p, p), upper half.
    border : (p, b), pivots by boundary.
    schur : (b, b), without columns before.
    """
    added = [0] * len(children)
    for parent_tile in range(-1, len(schur.edges) - 1):
        if parent_tile >= 0:
            schur.add_column()
        for which, (child, runs) in enumerate(children):
            while added[which] < len(runs) and runs[added[which]].parent_tile == parent_tile:
                column = runs[added[which]]
                _add_columns(child, runs[: added[which] + 1], pivots, border, schur)
                added[which] += 1
                if added[which] == len(runs) or runs[added[which]].child_tile != column.child_tile:
                    child.give_up(column.child_tile)


def _add_columns(
    child: UpperTiles,
    runs: list[Run],
    pivots: NDArray[np.float64],
    border: NDArray[np.float64],
    schur: UpperTiles,
) -> None:
    """Add the columns of the last run, down to the diagonal."""
    column = runs[-1]
    for row in runs:
        source = child.tiles[column.child_tile][row.child_tile][row.child, column.child]
        if column.parent_tile < 0:
            pivots[row.parent, column.parent] += source
        elif row.parent_tile < 0:
            border[row.parent, column.onward] += source
        else:
            schur.tiles[column.parent_tile][row.parent_tile][row.parent, column.parent] += source
