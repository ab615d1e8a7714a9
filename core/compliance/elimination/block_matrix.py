"""Stiffness by node: 3x3 blocks, and the graph of nodes that they connect."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array


@dataclass(frozen=True, eq=False)
class BlockMatrix:
    """Symmetric matrix of 3x3 blocks, in no particular order.

    Attributes
    ----------
    node_count : n; the matrix is (3n, 3n).
    rows, columns : int64 (m,), indices of the blocks.
    blocks : float64 (m, 3, 3).
    """

    node_count: int
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    blocks: NDArray[np.float64]

    @property
    def edges(self) -> NDArray[np.int64]:
        """Pairs of different nodes with a nonzero block, (e, 2), each pair once; of both halves."""
        above = self.rows < self.columns
        return np.stack([self.rows[above], self.columns[above]], axis=1)

    def upper_half(self, place: NDArray[np.int64]) -> BlockMatrix:
        """The blocks whose row comes first, or with the column, where node i is at ``place[i]``."""
        kept = place[self.rows] <= place[self.columns]
        return BlockMatrix(self.node_count, self.rows[kept], self.columns[kept], self.blocks[kept])

    @property
    def nbytes(self) -> int:
        """Bytes of the blocks and of their numbers."""
        return self.rows.nbytes + self.columns.nbytes + self.blocks.nbytes

    @property
    def index_bytes(self) -> int:
        """Bytes of three numbers a block."""
        return 3 * self.rows.nbytes


def free_blocks(stiffness: csr_array, free: NDArray[np.int64]) -> BlockMatrix:
    """Blocks of ``stiffness`` (3N, 3N) between the nodes ``free`` (n,), numbered 0 to n - 1.

    The graph comes from the matrix and not from the tetrahedra, because a formulation may connect
    nodes that share no tetrahedron.
    """
    by_block = stiffness.tobsr(blocksize=(3, 3))
    number = np.full(stiffness.shape[0] // 3, -1, dtype=np.int64)
    number[free] = np.arange(len(free))
    rows = np.repeat(number, np.diff(by_block.indptr))
    columns = number[by_block.indices]
    kept = (rows >= 0) & (columns >= 0)
    return BlockMatrix(len(free), rows[kept], columns[kept], by_block.data[kept])
