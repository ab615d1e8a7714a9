"""Dense compliance, as in the paper: every number of L stored."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dgemv, sgemv

# Bytes of a stored table for each pair of free surface nodes: nine float32 numbers.
BYTES_PER_PAIR = 36

# Nodes whose columns are summed in the table's precision before rounding errors matter.
NODES_SUMMED = 32


@dataclass(frozen=True, eq=False)
class DenseCompliance:
    """Compliance that holds the full table L.

    Attributes
    ----------
    free_surface : int64 (n,), node numbers, ascending.
    table : float32 or float64 (n, 3, 3n). ``table[j, c].reshape(n, 3)`` holds the
        displacements of all free surface nodes under 1 N on node j along axis c, for E = 1 Pa.
    """

    free_surface: NDArray[np.int64]
    table: NDArray[np.floating]

    form = "dense"

    @property
    def node_count(self) -> int:
        """Number of free surface nodes, n."""
        return len(self.free_surface)

    @property
    def nbytes(self) -> int:
        """Bytes of the table."""
        return self.table.nbytes

    def block(self, i: int, j: int) -> NDArray[np.float64]:
        """L_ij, (3, 3): displacement of node i per force on node j."""
        return self.table[j, :, 3 * i : 3 * i + 3].T.astype(np.float64)

    def blocks(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """L_ij for every i of ``rows`` (a,) and j of ``columns`` (b,), (a, b, 3, 3)."""
        seen_by_node = self.table.reshape(self.node_count, 3, self.node_count, 3)
        found = seen_by_node[np.asarray(columns)[:, None], :, np.asarray(rows)[None, :], :]
        return found.transpose(1, 0, 3, 2).astype(np.float64, order="C")

    def diagonal(self) -> NDArray[np.float64]:
        """All blocks L_ii, (n, 3, 3)."""
        seen_by_node = self.table.reshape(self.node_count, 3, self.node_count, 3)
        own = np.arange(self.node_count)
        return seen_by_node[own, :, own, :].transpose(0, 2, 1).astype(np.float64)

    def columns(self, nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        """The columns of L for forces on ``nodes`` (k,), as a matrix (3n, 3k)."""
        rows = self.table[nodes].reshape(-1, 3 * self.node_count)
        return rows.T.astype(np.float64)

    def apply(
        self, nodal_forces: NDArray[np.float64], nodes: NDArray[np.int64] | None = None
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) under ``nodal_forces`` (k, 3) on ``nodes`` (k,); equation (15).

        Without ``nodes`` there is one force for every node, (n, 3). Columns of up to 32 nodes are
        summed in the table's precision, these sums in float64: about as fast as a copy of the
        columns, with an error of 1e-7 of the largest displacement.
        """
        loaded = np.arange(self.node_count) if nodes is None else nodes
        forces = np.asarray(nodal_forces, dtype=self.table.dtype).reshape(-1, 3)
        if len(loaded) <= NODES_SUMMED:
            return self._moved_by_few(loaded, forces).reshape(-1, 3)
        total = self._moved_by_few(loaded[:NODES_SUMMED], forces[:NODES_SUMMED])
        for first in range(NODES_SUMMED, len(loaded), NODES_SUMMED):
            few = slice(first, first + NODES_SUMMED)
            total += self._moved_by_few(loaded[few], forces[few])
        return total.reshape(-1, 3)

    def _moved_by_few(
        self, nodes: NDArray[np.int64], forces: NDArray[np.floating]
    ) -> NDArray[np.float64]:
        """Displacements (3n,) under forces (k, 3), summed in the table's precision."""
        if not len(nodes):
            return np.zeros(3 * self.node_count)
        gemv = sgemv if self.table.dtype == np.float32 else dgemv
        # A node's columns are contiguous, (3n, 3) in Fortran order, as BLAS needs them.
        moved = gemv(1.0, self.table[nodes[0]].T, forces[0])
        for node, force in zip(nodes[1:], forces[1:], strict=True):
            gemv(1.0, self.table[node].T, force, 1.0, moved, overwrite_y=True)
        return moved.astype(np.float64)
