"""What one finger presses with."""

from __future__ import annotations

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
