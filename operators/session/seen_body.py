"""Body as drawn by a press: its shape under the fingers, written into the live layer."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.tool_surface import surface_and_correction
from ...core.sentence import Sentence
from ...core.servo.session import Snapshot
from ...core.shape.meeting import FingerLoad
from ..layer import live_layer
from ..object.drawn_body import DrawnBody
from ..shape.drawn_shape import DrawnShape, chosen_shape, loads_of
from ..tool.finger_tip import FingerTip
from .press_effects import Say

Array = NDArray[np.float64]

KEPT_EARLY = "It is kept as far as it was computed, {share} %"


@dataclass(eq=False)
class SeenBody:
    """Drawn body: ``displacements`` (n, 3) of the free surface nodes as drawn, and ``linear`` as
    the force was computed with; None while nothing touches.
    """

    drawn: DrawnBody
    tip: FingerTip
    displacements: Array | None = None
    linear: Array | None = None
    drawn_contact: tuple[object, ...] = ()
    _loads: tuple[FingerLoad, ...] = ()
    _modulus: float = 1.0

    @cached_property
    def shape(self) -> DrawnShape:
        """Shape of the body under its fingers."""
        return DrawnShape(self.drawn.body, self.drawn.file)

    @cached_property
    def surface_samples(self) -> Array:
        """Places (n, 3) spread over the rest surface, as densely as the tool needs, metres."""
        tool = self.tip.tool
        if tool is None:
            return self.drawn.surface_nodes
        return surface_and_correction(self.drawn.body, tool)[0].positions

    def nodes(self) -> Array:
        """All nodes of the body as drawn, (N, 3), body coordinates."""
        nodes = self.drawn.body.mesh.nodes
        if self.displacements is None:
            return nodes
        return nodes + self.drawn.node_displacements(self.displacements)

    def draw(self, thing: bpy.types.Object, snapshot: Snapshot, young_modulus: float) -> None:
        """Draw a tick, unless it is already drawn."""
        self.shape.follow(chosen_shape(thing))
        fingers = tuple(
            (finger.touching, finger.nodes.tobytes(), finger.nodal_forces.tobytes())
            for finger in snapshot.fingers
        )
        contact = (self.shape.name, self.shape.ready, young_modulus, fingers)
        if contact == self.drawn_contact:
            return
        self.drawn_contact = contact
        self._loads, self._modulus = tuple(loads_of(self.drawn.body, snapshot)), young_modulus
        if not self._loads:
            self.displacements = self.linear = None
            live_layer.write(thing, np.zeros_like(self.drawn.rest))
            return
        met = self.shape.draw(self._loads, young_modulus)
        if not met.settled or self.shape.ready < 1.0:
            # Still incomplete: drawn again in the next frame.
            self.drawn_contact = ()
        self.displacements, self.linear = met.displacements, met.linear
        self._write(thing, met.displacements, snapshot)

    def draw_rest(self, thing: bpy.types.Object | None) -> None:
        """Draw the rest shape."""
        self.displacements, self.linear, self.drawn_contact = None, None, ()
        if thing is not None:
            live_layer.write(thing, np.zeros_like(self.drawn.rest))

    def finish(self, thing: bpy.types.Object, snapshot: Snapshot | None) -> list[Say]:
        """Draw the shape to keep, as far as its tables are ready."""
        if not self._loads or self.drawn_contact:
            return []
        met = self.shape.finish(self._loads, self._modulus)
        self._write(thing, met.displacements, snapshot)
        if self.shape.ready == 1.0:
            return []
        share = f"{100 * self.shape.ready:.0f}"
        return [Say(Sentence(KEPT_EARLY, share=share), warning=True)]

    def _write(
        self, thing: bpy.types.Object, displacements: Array, snapshot: Snapshot | None
    ) -> None:
        tools = () if snapshot is None else self.tip.pressing(snapshot)
        live_layer.write(thing, self.drawn.drawn_displacement(displacements, tools))
