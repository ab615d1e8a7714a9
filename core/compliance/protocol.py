"""Interface of the compliance, L of the paper's equations (4) to (8), in all its forms.

All values are for a Young's modulus of 1 Pa: divide displacements by the real modulus.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray


class Compliance(Protocol):
    """Displacements of the free surface nodes per newton on each of them, at unit modulus.

    Nodes are counted by their place among ``free_surface``, 0 to n - 1.
    """

    @property
    def form(self) -> str:
        """Name of the form in files and panels: ``dense`` or ``compressed``."""
        ...

    @property
    def free_surface(self) -> NDArray[np.int64]:
        """Node numbers (n,) of the body's free surface, ascending."""
        ...

    @property
    def node_count(self) -> int:
        """Number of free surface nodes, n."""
        ...

    @property
    def nbytes(self) -> int:
        """Bytes of the numbers of this form."""
        ...

    def block(self, i: int, j: int) -> NDArray[np.float64]:
        """L_ij, (3, 3): displacement of node i per force on node j."""
        ...

    def blocks(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """L_ij for every i of ``rows`` (a,) and j of ``columns`` (b,), (a, b, 3, 3)."""
        ...

    def diagonal(self) -> NDArray[np.float64]:
        """All blocks L_ii, (n, 3, 3)."""
        ...

    def columns(self, nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        """The columns of L for forces on ``nodes`` (k,), as a matrix (3n, 3k)."""
        ...

    def apply(
        self, nodal_forces: NDArray[np.float64], nodes: NDArray[np.int64] | None = None
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) under ``nodal_forces`` (k, 3) on ``nodes`` (k,); equation (15).

        Without ``nodes`` there is one force for every node, (n, 3).
        """
        ...
