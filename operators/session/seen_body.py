"""Body as drawn by a press: its shape under the fingers, written into the live layer."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.tool_surface import surface_and_correction
from ...core.sentence import Sentence
from ...core.servo.session import Snapshot
from ...core.shape.meeting import Met
from ...core.shape.rotation_strain.finger_load import FingerLoad, let_go
from ...core.shape.shapes import Shape
from ..imprint import kept_imprint
from ..imprint.kept_imprint import NothingStaysError
from ..imprint.surface_imprint import SurfaceImprint, yielding_of
from ..layer import live_layer
from ..lying.pressed.pressed_prop import PressedProp
from ..object.baked_settings import law_of_object
from ..object.drawn_body import DrawnBody
from ..shape.drawn_shape import DrawnShape, chosen_shape, loads_of
from ..tool.finger_tip import FingerTip
from ..traction import layer_traction
from ..traction.drawn_traction import patches_in, tractions_of
from .press_effects import Say

Array = NDArray[np.float64]

# Until one tells of a finger that was set down.
TICKS_TO_LIFT = 2
KEPT_EARLY = "It is kept as far as it was computed, {share} %"


@dataclass(eq=False)
class SeenBody:
    """Drawn body: ``displacements`` (n, 3) of the free surface nodes as drawn, and ``linear`` as
    the force was computed with; None while nothing touches. ``prop`` is what it is where nobody
    holds it, and ``touches`` whether a finger does.
    """

    drawn: DrawnBody
    tip: FingerTip
    prop: PressedProp | None = None
    touches: bool = False
    displacements: Array | None = None
    linear: Array | None = None
    drawn_contact: tuple[object, ...] = ()
    imprint: SurfaceImprint = field(init=False)
    _loads: tuple[FingerLoad, ...] = ()
    _touch: tuple[FingerLoad, ...] = ()
    _modulus: float = 1.0
    _lifted_at: int = -1

    def __post_init__(self) -> None:
        self.imprint = SurfaceImprint(self.drawn.frame)

    @cached_property
    def shape(self) -> DrawnShape:
        """Shape of the body under its fingers."""
        return DrawnShape(self.drawn.at_rest, self.drawn.file)

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

    def draw(
        self,
        thing: bpy.types.Object,
        snapshot: Snapshot,
        young_modulus: float,
        touch: tuple[FingerLoad, ...],
    ) -> Shape:
        """Draw a tick, unless it is already drawn; the shape that is drawn. ``touch``: loads whose
        force may be that of the body at rest.
        """
        self._touch = touch
        self.shape.follow(chosen_shape(thing), law_of_object(thing))
        self._draw(thing, snapshot, young_modulus)
        return self.shape.made

    def _draw(self, thing: bpy.types.Object, snapshot: Snapshot, young_modulus: float) -> None:
        fingers = tuple(
            (finger.touching, finger.nodes.tobytes(), finger.nodal_forces.tobytes())
            for finger in snapshot.fingers
        )
        besides = snapshot.remembered_forces.tobytes(), snapshot.borne_forces.tobytes()
        rest = self.shape.at_rest(self._touch, young_modulus)
        ready = self.shape.ready, rest is not None
        contact = (self.shape.name, ready, young_modulus, fingers, besides)
        fades = self.imprint.fades(yielding_of(thing, self.drawn.frame))
        if contact == self.drawn_contact and not fades:
            return
        self.drawn_contact = contact
        self.touches = any(finger.touching for finger in snapshot.fingers)
        # A finger that was set down elsewhere is told by the last tick where it was before.
        is_past = snapshot.tick <= self._lifted_at
        is_past &= not (len(snapshot.remembered_nodes) or len(snapshot.borne_nodes))
        found = loads_of(self.drawn.body, snapshot, let_go(self._touch))
        self._loads = () if is_past else tuple(found)
        self._modulus = young_modulus
        if not self._loads:
            self.displacements = self.linear = None
            self._write(thing, None, snapshot)
            return
        met = self.shape.draw(self._loads, young_modulus)
        if rest is not None:
            met = Met(rest, met.linear, 0.0)
        if not met.settled or self.shape.ready < 1.0:
            # Still incomplete: drawn again in the next frame.
            self.drawn_contact = ()
        self.displacements, self.linear = met.displacements, met.linear
        self._write(thing, met.displacements, snapshot)

    def draw_rest(self, thing: bpy.types.Object | None) -> None:
        """Draw the rest shape."""
        self.displacements, self.linear, self.drawn_contact = None, None, ()
        if thing is not None:
            live_layer.write(thing, self._left())

    def lift(self, tick: int) -> None:
        """The finger was set down on the surface as it is, at this tick."""
        self.imprint.settle()
        self._lifted_at, self.drawn_contact = tick + TICKS_TO_LIFT, ()

    def stays(self, thing: bpy.types.Object) -> bool:
        """Whether there would be something to keep."""
        if self.prop is not None and self.prop.has_moved(self.drawn):
            return True
        if yielding_of(thing, self.drawn.frame).elastic:
            return self.displacements is not None and (self.touches or self.prop is None)
        return self.imprint.is_left

    def keep(
        self, thing: bpy.types.Object, scene: bpy.types.Scene, snapshot: Snapshot | None
    ) -> tuple[str, list[Say]]:
        """Keep the live layer; its name, empty where the object springs back, and remarks."""
        said = self._finish(thing, snapshot)
        if self.prop is not None:
            self.prop.leave(thing, self.drawn)
            if not (self.touches or self.imprint.is_left):
                # It has only been moved.
                live_layer.remove(thing)
                return "", said
        try:
            name = kept_imprint.keep(thing, scene, self.drawn.frame, self._left())
        except NothingStaysError as problem:
            live_layer.remove(thing)
            return "", [*said, Say(problem.sentence)]
        return name, said

    def _finish(self, thing: bpy.types.Object, snapshot: Snapshot | None) -> list[Say]:
        """Draw the shape to keep, as far as its tables are ready."""
        if not self._loads or self.drawn_contact:
            return []
        met = self.shape.finish(self._loads, self._touch, self._modulus)
        self._write(thing, met.displacements, snapshot)
        if self.shape.ready == 1.0:
            return []
        share = f"{100 * self.shape.ready:.0f}"
        return [Say(Sentence(KEPT_EARLY, share=share), warning=True)]

    def _write(
        self, thing: bpy.types.Object, displacements: Array | None, snapshot: Snapshot | None
    ) -> None:
        pressed = None if displacements is None else snapshot
        drawn = self.drawn
        if displacements is None:
            moved = np.zeros_like(drawn.rest)
        else:
            tools = () if pressed is None else self.tip.pressing(pressed)
            moved = drawn.drawn_displacement(displacements, tools, drawn.canvas)
        if self.prop is not None:
            moved = self.prop.beyond_rest(self.drawn, moved)
        law, now = yielding_of(thing, self.drawn.frame), 0.0 if snapshot is None else snapshot.time
        live_layer.write(thing, self.imprint.seen(law, moved, now))
        patches = patches_in(pressed, self.tip.tool)
        layer_traction.write(thing, tractions_of(thing, self.drawn, moved, patches))

    def _left(self) -> NDArray[np.float32]:
        return self.imprint.left(len(self.drawn.rest) // 3)
