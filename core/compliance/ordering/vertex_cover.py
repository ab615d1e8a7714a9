"""Minimum vertex cover of a bipartite graph."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_bipartite_matching


def minimum_vertex_cover(left: NDArray[np.int64], right: NDArray[np.int64]) -> NDArray[np.int64]:
    """Fewest nodes (k,) that include an end of each edge ``left[i]`` to ``right[i]``.

    By Koenig's theorem a maximum matching has as many edges as the smallest cover has nodes. The
    cover consists of the left nodes that no alternating path from an unmatched left node reaches,
    and of the right nodes that one does. Left and right nodes must not share numbers.
    """
    left_nodes, left_ends = np.unique(left, return_inverse=True)
    right_nodes, right_ends = np.unique(right, return_inverse=True)
    graph = csr_array(
        (np.ones(len(left_ends), dtype=np.int8), (left_ends, right_ends)),
        shape=(len(left_nodes), len(right_nodes)),
    )
    partner = maximum_bipartite_matching(graph, perm_type="column")
    matched = np.flatnonzero(partner >= 0)
    partner_of_right = np.full(len(right_nodes), -1, dtype=np.int64)
    partner_of_right[partner[matched]] = matched
    reached_left = partner < 0
    reached_right = np.zeros(len(right_nodes), dtype=bool)
    fresh = reached_left.copy()
    while fresh.any():
        seen = np.zeros(len(right_nodes), dtype=bool)
        seen[right_ends[fresh[left_ends]]] = True
        seen &= ~reached_right
        reached_right |= seen
        fresh = np.zeros(len(left_nodes), dtype=bool)
        # Every right node reached is matched, or the matching could have been larger.
        fresh[partner_of_right[seen]] = True
        fresh &= ~reached_left
        reached_left |= fresh
    return np.concatenate([left_nodes[~reached_left], right_nodes[reached_right]])
