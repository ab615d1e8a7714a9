"""Sparsity pattern of a solid's tangent stiffness, the same for all displacements."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array


@dataclass(frozen=True, eq=False)
class NodePairs:
    """Pairs of nodes within domains, the first node's number not above the second's.

    Attributes
    ----------
    rows, columns : int64 (p,), the two nodes.
    domain : int64 (p,), where they meet.
    first, second : int64 (p,), their places in the two arrays that follow.
    gradients : (q, 3), of every node in each of its domains.
    gradient_domain : int64 (q,), that domain.
    """

    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    domain: NDArray[np.int64]
    first: NDArray[np.int64]
    second: NDArray[np.int64]
    gradients: NDArray[np.float64]
    gradient_domain: NDArray[np.int64]

    @classmethod
    def of(cls, gradients: csr_array) -> NodePairs:
        """Pairs of nodes of csr (3D, N), as in :class:`.solid.StrainTerm`."""
        blocks = gradients.tobsr((3, 1))
        blocks.sort_indices()
        counts = np.diff(blocks.indptr).astype(np.int64)
        sizes = counts * counts
        domain = np.repeat(np.arange(len(counts)), sizes)
        within = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        first, second = np.divmod(within, counts[domain])
        upper = first <= second
        domain, first, second = domain[upper], first[upper], second[upper]
        first += blocks.indptr[domain]
        second += blocks.indptr[domain]
        nodes, values = blocks.indices.astype(np.int64), blocks.data[:, :, 0]
        own_domain = np.repeat(np.arange(len(counts)), counts)
        return cls(nodes[first], nodes[second], domain, first, second, values, own_domain)


@dataclass(frozen=True, eq=False)
class TangentPattern:
    """Pattern of 3x3 blocks of a symmetric matrix, found once for many matrices.

    Attributes
    ----------
    rows, columns : int64 (m,), in both halves; ordered by row, then by column.
    sums : csr (u, p), adds blocks of one place in the upper half.
    source : int64 (m,), which of those u blocks each of the m is,
    mirrored : bool (m,), and whether it is that block's transpose.
    """

    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    sums: csr_array
    source: NDArray[np.int64]
    mirrored: NDArray[np.bool_]

    @classmethod
    def of(
        cls, rows: NDArray[np.int64], columns: NDArray[np.int64], node_count: int
    ) -> TangentPattern:
        """For blocks added at ``rows``, ``columns`` (p,), rows not above columns."""
        once, which = np.unique(rows * node_count + columns, return_inverse=True)
        count = len(which)
        sums = coo_array((np.ones(count), (which, np.arange(count))), shape=(len(once), count))
        row, column = np.divmod(once, node_count)
        below = np.flatnonzero(row != column)
        all_rows, all_columns = np.append(row, column[below]), np.append(column, row[below])
        source = np.append(np.arange(len(once)), below)
        order = np.lexsort((all_columns, all_rows))
        return cls(
            all_rows[order],
            all_columns[order],
            sums.tocsr(),
            source[order],
            (np.arange(len(source)) >= len(once))[order],
        )

    @cached_property
    def own(self) -> NDArray[np.int64]:
        """Which of the blocks is each node's own, (N,)."""
        return np.flatnonzero(self.rows == self.columns)

    def usual_firmness(self, blocks: NDArray[np.float64]) -> float:
        """How firm a usual node is by itself along an axis, of a matrix's blocks (m, 3, 3)."""
        return float(np.median(np.einsum("nii->ni", blocks[self.own])))

    def summed(self, blocks: NDArray[np.float64]) -> NDArray[np.float64]:
        """Blocks (p, 3, 3) added at their places, (m, 3, 3) in both halves."""
        upper = (self.sums @ blocks.reshape(-1, 9)).reshape(-1, 3, 3)
        every: NDArray[np.float64] = upper[self.source]
        every[self.mirrored] = every[self.mirrored].transpose(0, 2, 1)
        return every
