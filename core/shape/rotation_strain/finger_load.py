"""What one finger presses with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...contact.tool.pose import Pose
from ...contact.tool.tools import Tool

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Setting:
    """A tool where it is."""

    tool: Tool
    pose: Pose

    def same(self, other: Setting) -> bool:
        """Whether it is that tool at that place."""
        return self.tool is other.tool and all(
            np.array_equal(getattr(self.pose, part), getattr(other.pose, part))
            for part in ("position", "rotation")
        )


@dataclass(frozen=True, eq=False)
class FingerLoad:
    """Load of one finger by the linear force law: forces (k, 3), N, on nodes (k,) of the mesh.

    ``sticks``: a point, which moves its place by all of its way; a tool's places may slide. ``by``:
    the tool, where it is known and slides without friction.
    """

    nodes: NDArray[np.int64]
    forces: Array
    sticks: bool = False
    by: Setting | None = None

    def times(self, share: float) -> FingerLoad:
        """With so much of its forces."""
        return replace(self, forces=share * self.forces)

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
        and _same_tool(one.by, other.by)
        and np.abs(one.forces - other.forces).sum() <= share * np.abs(one.forces).sum()
        for one, other in zip(loads, others, strict=True)
    )


def _same_tool(one: Setting | None, other: Setting | None) -> bool:
    return one is other or (one is not None and other is not None and one.same(other))
