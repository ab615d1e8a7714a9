"""Frames of soft objects that press each other: all go on together from one to the next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from ....core.errors import PalpateError
from ....core.rest.following import follow
from ...lying.free_pile import FreePile, piled, supports_of_all
from ...lying.laid import is_animated
from ...object.drawn_body import DrawnBody
from ...scene.drawn_surface import metres_per_unit
from .around import Around
from .lying_frames import lying_frame, placed
from .pressed_frames import PressedFrame
from .pressers import Presser, pressers_of


@dataclass(eq=False)
class PiledFrames:
    """Objects of which nobody holds some, followed from frame to frame, ``seconds`` apart."""

    things: Sequence[bpy.types.Object]
    opened: Sequence[DrawnBody]
    seconds: float
    _around: Around | None = None
    _pile: FreePile | None = None

    def now(self, graph: bpy.types.Depsgraph) -> tuple[PressedFrame, ...]:
        """Where they are in the frame that a graph has; in the first one where their objects are.

        Raises
        ------
        PalpateError
            A presser or collider cannot be used, or a force is no number.
        """
        before = self._around
        if before is None or self._pile is None:
            pairs = zip(self.things, self.opened, strict=True)
            self.opened = [placed(thing, drawn, graph) for thing, drawn in pairs]
            pile = piled(self.things, self.opened, graph)
            self._around = around = self._around_in(graph)
            self._pile = pile.touched_by(around.tools) if around.pressers else pile
        else:
            self._around = around = self._around_in(graph)
            if around.is_like(before):
                follow(self._pile.firm, around.ways_from(before), self.seconds)
            else:
                self._pile = self._pile.touched_by(around.tools, supports=around.supports)
        self._pile.firm.look()
        return tuple(lying_frame(lying, graph) for lying in self._pile.now())

    def _around_in(self, graph: bpy.types.Depsgraph) -> Around:
        supports = supports_of_all(self.things, self.opened, graph)
        return Around(self._pressers_in(graph), supports, metres_per_unit(graph.scene))

    def _pressers_in(self, graph: bpy.types.Depsgraph) -> list[Presser]:
        """Those of all, each once."""
        found, collections = [], []
        for thing, drawn in zip(self.things, self.opened, strict=True):
            chosen = thing.palpate.pressers
            if chosen is not None and chosen not in collections:
                collections.append(chosen)
                found.extend(pressers_of(thing, graph, drawn))
        return found


def refuse_moving(things: Sequence[bpy.types.Object]) -> None:
    """Refuse pinned objects that keyframes move, among ones that nobody holds.

    Raises
    ------
    PalpateError
        With the remedy.
    """
    for thing in things:
        if thing.palpate.pin_mode != "NONE" and is_animated(thing):
            raise PalpateError(
                "{name}: keyframes or drivers place it, and a pinned soft object that others lie "
                "on stands still; clear them, or choose Pins: None",
                name=thing.name,
            )
