"""Nested dissection: the order of elimination, as a tree of small groups of nodes.

A region is cut across one of its main directions. The nodes that cover all edges across the cut are
its separator; they are eliminated after both sides, which therefore stay disconnected. The sides
are cut again until they are small.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ...mesh.coordinates import along_z_curve
from ...progress import Progress, unwatched
from .vertex_cover import minimum_vertex_cover

# Regions of so few nodes are one dense front: further cuts would cost more in calls than they save
# in arithmetic.
LEAF_NODES = 64

# Larger regions are cut across each of three main directions at several heights (shares of nodes
# below), and the best cut is taken: their separators cost most. Smaller ones are halved across
# their longest direction.
TRY_SEVERAL_CUTS_ABOVE = 1000
HEIGHTS_TRIED = (0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65)

# Share of nodes that a separator must save to outweigh an off-centre cut.
IMBALANCE_PENALTY = 0.3


@dataclass(frozen=True, eq=False)
class Dissection:
    """Groups of nodes in order of elimination; each group is the pivots of one front.

    Attributes
    ----------
    order : int64 (n,), the nodes in order of elimination.
    starts : int64 (f + 1,), front i eliminates ``order[starts[i]:starts[i + 1]]``.
    parents : int64 (f,), the front that a front's update is added to; -1 for roots. Fronts are
        in postorder: a front's descendants stand directly before it.
    """

    order: NDArray[np.int64]
    starts: NDArray[np.int64]
    parents: NDArray[np.int64]


def dissect(
    edges: NDArray[np.int64],
    positions: NDArray[np.float64],
    last: NDArray[np.bool_],
    leaf_nodes: int = LEAF_NODES,
    progress: Progress = unwatched,
) -> Dissection:
    """Order of elimination that keeps fronts small.

    Parameters
    ----------
    edges : (e, 2), pairs of connected nodes, each pair once.
    positions : (n, 3) of the nodes; affect the quality of the cuts, not their validity.
    last : (n,), nodes that come last within their leaf: the only ones that carry loads.
    leaf_nodes : regions of at most so many nodes are not cut.
    progress : called before every trial cut with the approximate share done; may raise to cancel.
    """
    expected = len(edges) * max(_cuts_expected(len(positions), leaf_nodes), 1.0)
    sorted_edges = 0

    def tried(count: int) -> None:
        nonlocal sorted_edges
        sorted_edges += count
        progress(min(sorted_edges / max(expected, 1.0), 1.0))

    # Numbered along a space-filling curve, nodes of a separator stand next to their neighbours, and
    # a front's boundary maps to the fronts above it in few runs.
    curve = along_z_curve(positions)
    along = np.empty_like(curve)
    along[curve] = np.arange(len(curve))
    positions, last, edges = positions[curve], last[curve], along[edges]
    pivots: list[NDArray[np.int64]] = []
    parents: list[int] = []

    def add_front(nodes: NDArray[np.int64], below: list[int]) -> list[int]:
        for front in below:
            parents[front] = len(pivots)
        pivots.append(nodes)
        parents.append(-1)
        return [len(pivots) - 1]

    def add_region(nodes: NDArray[np.int64], inside: NDArray[np.int64]) -> list[int]:
        """Add the fronts of a region (k,) with edges (e, 2) within it; return its roots."""
        if len(nodes) > leaf_nodes:
            pieces = _pieces(len(nodes), inside, leaf_nodes)
            if len(pieces) > 1:
                return [top for piece in pieces for top in add_region(*_part(nodes, inside, piece))]
            cut = _best_cut(positions[nodes], inside, tried)
            if len(cut.first) and len(cut.second):
                below = add_region(*_part(nodes, inside, cut.first))
                below += add_region(*_part(nodes, inside, cut.second))
                return add_front(nodes[cut.separator], below)
        return add_front(nodes[np.argsort(last[nodes], kind="stable")], [])

    add_region(np.arange(len(positions)), edges)
    sizes = [len(front) for front in pivots]
    return Dissection(
        curve[np.concatenate(pivots)], np.concatenate([[0], np.cumsum(sizes)]), np.array(parents)
    )


def _part(
    nodes: NDArray[np.int64], edges: NDArray[np.int64], part: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Nodes of a part of a region, and the edges within it, in the part's numbering."""
    number = np.full(len(nodes), -1, dtype=np.int64)
    number[part] = np.arange(len(part))
    ends = number[edges]
    return nodes[part], ends[(ends >= 0).all(axis=1)]


def _pieces(count: int, edges: NDArray[np.int64], enough: int) -> list[NDArray[np.int64]]:
    """Connected pieces of a region; small ones in bundles of at most ``enough`` nodes."""
    links = coo_array(
        (np.ones(len(edges), dtype=np.int8), (edges[:, 0], edges[:, 1])), (count,) * 2
    )
    pieces, label = connected_components(links, directed=False)
    if pieces == 1:
        return [np.arange(count)]
    sizes = np.bincount(label)
    # A bundle takes pieces until it is half full, and none that would overfill it.
    half = max(enough // 2, 1)
    small = sizes <= half
    before = np.cumsum(np.where(small, sizes, 0)) - sizes
    bundle = np.where(small, before // half, pieces + np.arange(pieces))[label]
    return [np.flatnonzero(bundle == which) for which in np.unique(bundle)]


@dataclass(frozen=True, eq=False)
class _Cut:
    """Sides and separator of a region, and the cost of eliminating them in this order."""

    first: NDArray[np.int64]
    second: NDArray[np.int64]
    separator: NDArray[np.int64]
    cost: float


def _cuts_expected(nodes: int, leaf_nodes: int) -> float:
    """Number of cuts that each edge is sorted for, if every cut halves its region."""
    several = max(0.0, np.log2(nodes / TRY_SEVERAL_CUTS_ABOVE))
    single = max(0.0, np.log2(min(nodes, TRY_SEVERAL_CUTS_ABOVE) / leaf_nodes))
    return float(3 * len(HEIGHTS_TRIED) * np.ceil(several) + np.ceil(single))


def _best_cut(
    positions: NDArray[np.float64], edges: NDArray[np.int64], tried: Callable[[int], None]
) -> _Cut:
    """Cheapest of the trial cuts; progress counts the edges that each sorts."""
    centred = positions - positions.mean(axis=0)
    directions = np.linalg.eigh(centred.T @ centred)[1].T[::-1]
    if len(positions) <= TRY_SEVERAL_CUTS_ABOVE:
        tried(len(edges))
        return _cut(_ranks(centred @ directions[0]), edges, 0.5)

    def cuts() -> Iterator[_Cut]:
        for ranks in (_ranks(centred @ direction) for direction in directions):
            for height in HEIGHTS_TRIED:
                tried(len(edges))
                yield _cut(ranks, edges, height)

    return min(cuts(), key=lambda cut: cut.cost)


def _ranks(heights: NDArray[np.float64]) -> NDArray[np.int64]:
    """Rank of each node by height, (k,), a permutation."""
    ranks = np.empty(len(heights), dtype=np.int64)
    ranks[np.argsort(heights, kind="stable")] = np.arange(len(heights))
    return ranks


def _cut(ranks: NDArray[np.int64], edges: NDArray[np.int64], height: float) -> _Cut:
    upper = ranks >= int(height * len(ranks))
    upper_ends = upper[edges]
    crossing = upper_ends[:, 0] != upper_ends[:, 1]
    across, reverse = edges[crossing], upper_ends[crossing, 0]
    left = np.where(reverse, across[:, 1], across[:, 0])
    right = np.where(reverse, across[:, 0], across[:, 1])
    separator = np.sort(minimum_vertex_cover(left, right))
    outside = np.ones(len(ranks), dtype=bool)
    outside[separator] = False
    return _Cut(
        np.flatnonzero(~upper & outside),
        np.flatnonzero(upper & outside),
        separator,
        len(separator) * (1 + IMBALANCE_PENALTY * abs(height - 0.5)),
    )
