"""The compliance as the paper has it: every number of L stored."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class DenseCompliance:
    """A :class:`palpate.core.compliance.Compliance` that holds the whole of L.

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

        Without ``nodes`` there is one force for every node, (n, 3).
        """
        loaded = np.arange(self.node_count) if nodes is None else nodes
        touched = self.table[loaded].reshape(-1, 3 * self.node_count)
        weights = np.asarray(nodal_forces, dtype=np.float64).reshape(-1)
        total = np.zeros(3 * self.node_count)
        for weight, column in zip(weights, touched, strict=True):
            total += weight * column
        return total.reshape(-1, 3)
