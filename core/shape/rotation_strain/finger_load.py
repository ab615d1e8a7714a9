"""What one finger presses with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FingerLoad:
    """Load of one finger by the linear force law: forces (k, 3), N, on nodes (k,) of the mesh.

    ``sticks``: a point, which moves its place by all of its way; a tool's places may slide.
    """

    nodes: NDArray[np.int64]
    forces: Array
    sticks: bool = False

    @property
    def weights(self) -> Array:
        """Share (k,) of the load that each node carries; of no load, alike."""
        sizes = np.linalg.norm(self.forces, axis=1)
        total = sizes.sum()
        alike = np.full(len(sizes), 1.0 / max(1, len(sizes)))
        shares: Array = sizes / total if total > 0.0 else alike
        return shares


def alike(loads: Sequence[FingerLoad], others: Sequence[FingerLoad], share: float = 0.0) -> bool:
    """Whether the same fingers press on the same nodes, by forces that differ by no more than a
    share of all of them.
    """
    return len(loads) == len(others) and all(
        one.sticks == other.sticks
        and np.array_equal(one.nodes, other.nodes)
        and np.abs(one.forces - other.forces).sum() <= share * np.abs(one.forces).sum()
        for one, other in zip(loads, others, strict=True)
    )
