"""What of a held body's compliance is rigid motion, and is taken out of a free one's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class RigidPart:
    """B R^T + R B^T of loaded freedoms; see the room's head.

    Attributes
    ----------
    modes : float64 (3n, 6), R, the rigid motions, orthonormal by mass.
    response : float64 (3n, 6), B.
    """

    modes: NDArray[np.float64]
    response: NDArray[np.float64]

    @classmethod
    def of(
        cls, modes: NDArray[np.float64], moved: NDArray[np.float64], energy: NDArray[np.float64]
    ) -> RigidPart:
        """The rigid part, from G = ``moved`` (3n, 6) and H = ``energy`` (6, 6)."""
        return cls(modes, moved - 0.5 * modes @ energy)

    def at(self, freedoms: NDArray[np.int64] | slice) -> RigidPart:
        """The same of some freedoms."""
        return RigidPart(self.modes[freedoms], self.response[freedoms])

    def against(self, columns: RigidPart) -> NDArray[np.float64]:
        """The part between these freedoms as rows and ``columns``, (3n, 3k)."""
        part: NDArray[np.float64] = (
            self.response @ columns.modes.T + self.modes @ columns.response.T
        )
        return part

    def diagonal(self) -> NDArray[np.float64]:
        """Its blocks of each node with itself, (n, 3, 3)."""
        modes, response = (part.reshape(-1, 3, 6) for part in (self.modes, self.response))
        half = response @ modes.transpose(0, 2, 1)
        blocks: NDArray[np.float64] = half + half.transpose(0, 2, 1)
        return blocks
