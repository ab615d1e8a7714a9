"""Frames of an object that nobody holds: it goes on from one to the next."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.rest.following import Ways, follow
from ..lying.free_body import FreeBody, lie, supports_under
from ..lying.supports import Supports, same_shapes, supports_of
from ..object.drawn_body import DrawnBody
from ..place.evaluation import evaluated
from ..scene.drawn_surface import frame_of, metres_per_unit
from .pressed_frames import PressedFrame, same_tools
from .pressers import Presser, pressers_of


@dataclass(frozen=True, eq=False)
class _Around:
    """What presses and bears a body in a frame."""

    pressers: list[Presser]
    supports: Supports
    metres: float

    @property
    def tools(self) -> list[tuple[Tool, Pose]]:
        """Tools with their poses in the world, metres."""
        return [(one.tool, Pose(self.metres * one.place, one.axes)) for one in self.pressers]

    def is_like(self, before: _Around) -> bool:
        """Whether all are of the same shapes, perhaps elsewhere."""
        return same_tools(self.pressers, before.pressers) and same_shapes(
            before.supports, self.supports
        )

    def ways_from(self, before: _Around) -> Ways:
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


@dataclass(eq=False)
class LyingFrames:
    """An object that nobody holds, followed from frame to frame, which are ``seconds`` apart."""

    thing: bpy.types.Object
    drawn: DrawnBody
    seconds: float
    _around: _Around | None = None
    _free: FreeBody | None = None

    def now(self, graph: bpy.types.Depsgraph) -> PressedFrame:
        """Where it is in the frame that a graph has; in the first one where its object is.

        Raises
        ------
        PalpateError
            A presser or collider cannot be used, or a force is no number.
        """
        around = self._around_in(graph)
        before, self._around = self._around, around
        if before is None or self._free is None or not around.is_like(before):
            placement = None if self._free is None else self._free.resting.rest.placement
            self._free = lie(self.thing, self.drawn, around.supports, around.tools, placement)
        else:
            follow(self._free.resting, around.ways_from(before), self.seconds)
        lying = self._free.now()
        forces = [one.force for one in lying.rest.tools]
        return PressedFrame(
            graph.scene.frame_current,
            lying.touches,
            np.array(forces).reshape(-1, 3),
            lying.moved if lying.moved.any() else None,
            lying.frame,
        )

    def _around_in(self, graph: bpy.types.Depsgraph) -> _Around:
        if self._around is None:
            here = frame_of(evaluated(self.thing, graph), graph.scene)
            self.drawn = replace(self.drawn, frame=replace(here, stretch=self.drawn.frame.stretch))
            supports = supports_under(self.thing, self.drawn, graph)
        else:
            supports = supports_of(self.thing, self.drawn, graph)
        has_pressers = self.thing.palpate.pressers is not None
        found = pressers_of(self.thing, graph, self.drawn) if has_pressers else []
        return _Around(found, supports, metres_per_unit(graph.scene))
