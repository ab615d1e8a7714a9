"""Result of a stroke."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ....core.contact.tool.tool_dent import PressingTool
from ....core.contact.touches import ToolTouch
from ....core.shape.found_behind import Shaped
from ....core.shape.rotation_strain.finger_load import FingerLoad
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
    loads, share : of a linear body so displaced; and of its forces that is felt.
    lying : where a body that nobody holds lies then; None of a pinned one.
    others : where soft ones lie that it rests on.
    springs_back : whether nothing of its shape stays once it is let go, but where it lies.
    ends : why it went no deeper, where more was asked; else empty.
    """

    displacements: NDArray[np.float64]
    force: float
    torque: float = 0.0
    touches: tuple[ToolTouch, ...] = ()
    loads: tuple[FingerLoad, ...] = ()
    share: float = 1.0
    lying: Lying | None = None
    others: tuple[Lying, ...] = ()
    springs_back: bool = False
    ends: str = ""

    @property
    def tools(self) -> tuple[PressingTool, ...]:
        """The tools that press."""
        return tuple(PressingTool(one.tool, one.pose, one.force) for one in self.touches)

    def shaped(self, shaped: Shaped) -> Stroked:
        """The same of a body that is no linear one."""
        share = shaped.share / self.share
        return replace(
            self,
            displacements=shaped.displacements,
            share=shaped.share,
            force=share * self.force,
            torque=share * self.torque,
            touches=tuple(one.times(share) for one in self.touches),
        )
