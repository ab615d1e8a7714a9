"""Symbolic step: nodes and loads of every front, before any arithmetic."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .dissection import Dissection


@dataclass(frozen=True, eq=False)
class Front:
    """Dense part of the elimination. All counts are nodes, three freedoms each.

    Attributes
    ----------
    start, stop : the pivots' places in the order of elimination.
    boundary : int64 (b,), places of later nodes connected to the pivots, ascending. Their
        Schur complement is added to the parent.
    children : fronts whose update is added here.
    load_start, load_stop : range of loads that arrive here, in order of elimination: those of all
        descendants, then those on this front's pivots.
    loaded_pivots : int64 (k,), the pivots that carry loads, counted within the front.
    """

    start: int
    stop: int
    boundary: NDArray[np.int64]
    children: tuple[int, ...]
    load_start: int
    load_stop: int
    loaded_pivots: NDArray[np.int64]

    @property
    def pivot_count(self) -> int:
        """Nodes eliminated here."""
        return self.stop - self.start

    @property
    def load_count(self) -> int:
        """Loaded nodes here and below."""
        return self.load_stop - self.load_start

    @property
    def first_loaded(self) -> int:
        """First pivot that any load reaches; earlier ones never do."""
        if len(self.loaded_pivots) == self.load_count and self.load_count:
            return int(self.loaded_pivots[0])
        return 0


@dataclass(frozen=True, eq=False)
class SymbolicFactor:
    """Fronts in order, and the numbering of nodes.

    Attributes
    ----------
    order : int64 (n,), nodes in order of elimination.
    place : int64 (n,), the place of each node in that order.
    fronts : in postorder.
    loaded : int64 (s,), the loaded nodes in order of elimination.
    """

    order: NDArray[np.int64]
    place: NDArray[np.int64]
    fronts: tuple[Front, ...]
    loaded: NDArray[np.int64]


def analyse(
    dissection: Dissection, edges: NDArray[np.int64], loaded: NDArray[np.bool_]
) -> SymbolicFactor:
    """All fronts of an elimination.

    Parameters
    ----------
    dissection : of the same nodes.
    edges : (e, 2), pairs of connected nodes.
    loaded : (n,), nodes with unit loads.
    """
    order, starts, parents = dissection.order, dissection.starts, dissection.parents
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    ends = np.sort(place[edges], axis=1)
    ends = ends[np.argsort(ends[:, 0], kind="stable")]
    first_edge = np.searchsorted(ends[:, 0], starts)
    loads_before = np.concatenate([[0], np.cumsum(loaded[order])])
    children: list[list[int]] = [[] for _ in parents]
    fronts: list[Front] = []
    for index, parent in enumerate(parents):
        start, stop = int(starts[index]), int(starts[index + 1])
        below = children[index]
        reached = np.unique(
            np.concatenate(
                [ends[first_edge[index] : first_edge[index + 1], 1]]
                + [fronts[child].boundary for child in below]
            )
        )
        fronts.append(
            Front(
                start,
                stop,
                reached[reached >= stop],
                tuple(below),
                fronts[below[0]].load_start if below else int(loads_before[start]),
                int(loads_before[stop]),
                np.flatnonzero(loaded[order[start:stop]]),
            )
        )
        if parent >= 0:
            children[parent].append(index)
    return SymbolicFactor(order, place, tuple(fronts), order[loaded[order]])
