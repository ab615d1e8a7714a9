"""Source of exact columns of the compliance."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray


class ColumnSource(Protocol):
    """Compliance of the free surface nodes, column by column.

    Either a :class:`palpate.core.compliance.dense.DenseCompliance` or a factored stiffness that
    solves for the requested columns, so that L is never held in full.
    """

    @property
    def free_surface(self) -> NDArray[np.int64]:
        """Node numbers (n,) of the body's free surface, ascending."""
        ...

    @property
    def node_count(self) -> int:
        """Number of free surface nodes, n."""
        ...

    def columns(self, nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        """The columns of L for forces on ``nodes`` (k,), as a matrix (3n, 3k)."""
        ...

    def diagonal(self) -> NDArray[np.float64]:
        """All blocks L_ii, (n, 3, 3)."""
        ...
