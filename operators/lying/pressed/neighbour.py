"""A soft object beside one that is pressed: it moves and gives way with that."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ....core.body.soft_body import SoftBody
from ....core.contact.tool.pose import Pose
from ....core.shape.shapes import Shape
from ...object.drawn_body import DrawnBody
from ...scene.object_handle import ObjectHandle
from ...shape.drawn_shape import kept_shape
from .. import rest_layer
from ..before import Before
from ..free_body import Lying
from ..laid import move
from ..placement import apart, frame_at
from ..supports import Supports

Load = tuple[NDArray[np.int64], NDArray[np.float64]]

# Share of its size by which an object that was pressed has moved: less is the servo's rounding. And
# by which one is drawn anew.
MOVED, SEEN = 1e-3, 1e-5


@dataclass(eq=False)
class Neighbour:
    """A soft object that a pressed one rests on.

    Attributes
    ----------
    handle : of the object.
    drawn : its body, and the object as it was.
    body : the same at the object's density and Young's modulus.
    shape : of it.
    before : how the object lay.
    rested : where it came to rest before the press.
    supports : what all rest on.
    """

    handle: ObjectHandle
    drawn: DrawnBody
    body: SoftBody
    shape: Shape
    before: Before
    rested: Lying
    supports: Supports
    _shown: tuple[Pose, NDArray[np.float64]] | None = None

    def follow(self, placement: Pose, load: Load) -> None:
        """Show the object where its body is, under a load on nodes (k,) of its surface, (k, 3) N in
        its own axes.
        """
        thing = self.handle.find()
        if thing is None:
            return
        nodes, forces = load
        surface, modulus = self.body.mesh.surface_nodes, self.rested.rest.young_modulus
        displacements = self.shape.displacements(surface[nodes], forces, modulus)
        if self._away(placement, displacements) < SEEN:
            return
        self._shown = placement, displacements
        frame = self.drawn.frame
        if self.body.is_free:
            frame = frame_at(frame, placement)
            move(thing, frame)
        moved = self.drawn.drawn_displacement(displacements)
        rest_layer.show(thing, self.supports.keep_out(self.drawn, frame, moved))

    def give_back(self) -> None:
        """Have the object as it was before."""
        thing, self._shown = self.handle.find(), None
        if thing is not None:
            self.before.give_back(thing)

    @property
    def has_moved(self) -> bool:
        """Whether it is elsewhere, or another shape, than it came to rest before."""
        if self._shown is None:
            return False
        return self._away(self.rested.rest.placement, self.rested.displacements) > MOVED

    def _away(self, placement: Pose, displacements: NDArray[np.float64]) -> float:
        """How far a state is from what is shown, as a share of its size."""
        if self._shown is None:
            return np.inf
        shown, bent = self._shown
        size = self.drawn.size
        return max(apart(shown, placement, size), np.abs(bent - displacements).max() / size)


def neighbour(
    thing: bpy.types.Object, drawn: DrawnBody, body: SoftBody, rested: Lying, supports: Supports
) -> Neighbour:
    """An object as a neighbour of one that will be pressed."""
    handle, shape = ObjectHandle.of(thing), kept_shape(thing, drawn)
    return Neighbour(handle, drawn, body, shape, Before.of(thing), rested, supports)
