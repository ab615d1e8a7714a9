"""Frames of an object that nobody holds: it goes on from one to the next."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ....core.rest.following import follow
from ...lying.free_body import FreeBody, Lying, lie, supports_under
from ...lying.supports import supports_of
from ...object.drawn_body import DrawnBody
from ...place.evaluation import evaluated
from ...scene.drawn_surface import frame_of, metres_per_unit
from .around import Around
from .pressed_frames import PressedFrame
from .pressers import pressers_of


@dataclass(eq=False)
class LyingFrames:
    """An object that nobody holds, followed from frame to frame, which are ``seconds`` apart."""

    thing: bpy.types.Object
    drawn: DrawnBody
    seconds: float
    _around: Around | None = None
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
            borne = around.supports, around.tools, placement
            self._free = lie(self.thing, self.drawn, *borne, steady=self._is_steady)
        else:
            follow(self._free.firm, around.ways_from(before), self.seconds)
        self._free.firm.look()
        return lying_frame(self._free.now(), graph)

    @property
    def _is_steady(self) -> bool:
        """Whether a hand steadies it, as it does what is pressed."""
        chosen = self.thing.palpate
        return bool(chosen.steady and chosen.pressers is not None)

    def _around_in(self, graph: bpy.types.Depsgraph) -> Around:
        if self._around is None:
            self.drawn = placed(self.thing, self.drawn, graph)
            supports = supports_under(self.thing, self.drawn, graph)
        else:
            supports = supports_of(self.thing, self.drawn, graph)
        has_pressers = self.thing.palpate.pressers is not None
        found = pressers_of(self.thing, graph, self.drawn) if has_pressers else []
        return Around(found, supports, metres_per_unit(graph.scene))


def placed(thing: bpy.types.Object, drawn: DrawnBody, graph: bpy.types.Depsgraph) -> DrawnBody:
    """A body where its object is in a graph."""
    here = frame_of(evaluated(thing, graph), graph.scene)
    return replace(drawn, frame=replace(here, stretch=drawn.frame.stretch))


def lying_frame(lying: Lying, graph: bpy.types.Depsgraph) -> PressedFrame:
    """The frame of a body that lies so."""
    forces = [one.force for one in lying.rest.tools]
    return PressedFrame(
        graph.scene.frame_current,
        lying.touches,
        np.array(forces).reshape(-1, 3),
        lying.moved if lying.moved.any() else None,
        lying.frame,
    )
