"""Frames pressed one after the other, without a clock."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.press import ContactSettings, Press
from ...core.contact.touches import Touch
from ...core.shape.meeting import settled
from ...core.shape.shapes import Shape
from ..object.drawn_body import DrawnBody
from ..press.press_once import loads_of, pressing_tools
from . import pressers

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PressedFrame:
    """Result of a frame: each finger's force (N), and the displacements (n, 3), None if free."""

    frame: int
    fingers: tuple[Touch, ...]
    displacements: Array | None

    def coordinates(self, drawn: DrawnBody) -> NDArray[np.float32]:
        """Flat coordinates (3 p,) of the drawn vertices, local units."""
        if self.displacements is None:
            return drawn.rest
        tools = pressing_tools(self.fingers)
        return drawn.rest + drawn.drawn_displacement(self.displacements, tools)


def press_frames(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    drawn: DrawnBody,
    frames: Sequence[int],
    shape: Shape,
) -> Iterator[PressedFrame]:
    """Lead the scene's tools through these frames, one result each.

    Raises
    ------
    PalpateError
        The finger is a point, or nothing leads it.
    """
    tool, guides = pressers.tool_of(scene, thing, drawn.size), pressers.leading_objects(scene)
    modulus = thing.palpate.young_modulus
    settings = ContactSettings(modulus, thing.palpate.static_friction)
    press = Press(drawn.body, [tool] * len(guides), settings)
    for frame in frames:
        scene.frame_set(frame)
        touches = press.to([pressers.pose_of(guide, scene, drawn.frame) for guide in guides])
        loads = loads_of(touches)
        moved = settled(drawn.body, shape, loads, modulus).displacements if loads else None
        yield PressedFrame(frame, touches, moved)


@contextmanager
def frame_kept(scene: bpy.types.Scene) -> Iterator[None]:
    """The scene's frame is put back afterwards."""
    frame = scene.frame_current
    try:
        yield
    finally:
        scene.frame_set(frame)
