"""What presses and bears bodies in a frame, and how it goes on to the next."""

from __future__ import annotations

from dataclasses import dataclass

from ....core.contact.tool.pose import Pose
from ....core.contact.tool.tools import Tool
from ....core.rest.following import Ways
from ...lying.supports import Supports, same_shapes
from .pressed_frames import same_tools
from .pressers import Presser


@dataclass(frozen=True, eq=False)
class Around:
    """What presses and bears bodies in a frame; ``metres`` a unit of the scene is long."""

    pressers: list[Presser]
    supports: Supports
    metres: float

    @property
    def tools(self) -> list[tuple[Tool, Pose]]:
        """Tools with their poses in the world, metres."""
        return [(one.tool, Pose(self.metres * one.place, one.axes)) for one in self.pressers]

    def is_like(self, before: Around) -> bool:
        """Whether all are of the same shapes, perhaps elsewhere."""
        return same_tools(self.pressers, before.pressers) and same_shapes(
            before.supports, self.supports
        )

    def ways_from(self, before: Around) -> Ways:
        """From where all were."""
        return Ways(
            [
                (tool, start, end)
                for (tool, start), (_, end) in zip(before.tools, self.tools, strict=True)
            ],
            [
                (tool, start, start if tool is None else end)
                for (tool, start), (_, end) in zip(
                    before.supports.ways, self.supports.ways, strict=True
                )
            ],
        )
