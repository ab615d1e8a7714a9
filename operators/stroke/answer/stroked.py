"""Result of a stroke."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.contact.tool.tool_dent import PressingTool
from ....core.contact.touches import ToolTouch
from ...lying.free_body import Lying


@dataclass(frozen=True, eq=False)
class Stroked:
    """Result of a stroke.

    Attributes
    ----------
    displacements : float64 (n, 3), of the free surface nodes, metres.
    force : newton; at the first place where it is mirrored.
    torque : newton metres about the normal there.
    touches : of the tools that press, for drawing.
    lying : where a body that nobody holds lies then; None of a pinned one.
    springs_back : whether nothing of its shape stays once it is let go, but where it lies.
    """

    displacements: NDArray[np.float64]
    force: float
    torque: float = 0.0
    touches: tuple[ToolTouch, ...] = ()
    lying: Lying | None = None
    springs_back: bool = False

    @property
    def tools(self) -> tuple[PressingTool, ...]:
        """The tools that press."""
        return tuple(PressingTool(one.tool, one.pose, one.force) for one in self.touches)
