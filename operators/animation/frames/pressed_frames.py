"""Frames pressed one after the other, without a clock."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Protocol

import bpy
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ....core.contact.press import ContactSettings, Press
from ....core.contact.touches import Touch
from ....core.errors import PalpateError
from ....core.imprint.yielding import Yielding
from ....core.shape.felt import felt, loads_of
from ....core.shape.meeting import settled
from ....core.shape.shapes import Shape
from ...imprint.surface_imprint import SurfaceImprint
from ...layer import place_marks
from ...object.drawn_body import DrawnBody
from ...place import touched_place
from ...place.evaluation import evaluated
from ...press.press_once import pressing_tools
from ...scene.body_frame import BodyFrame
from ...scene.drawn_surface import frame_of
from ...shape.held_body import held
from .pressers import Presser, pressers_of

# Share of a tool's rounding by which it may differ from frame to frame.
SAME = 1e-3


@dataclass(frozen=True, eq=False)
class PressedFrame:
    """Result of a frame: each finger's touch and force (k, 3), N in world axes, and the flat
    displacements (3 p,) of the drawn vertices, local units; None where none moves. ``lies`` is the
    frame of an object that nobody holds.
    """

    frame: int
    fingers: tuple[Touch, ...]
    forces: NDArray[np.float64]
    moved: NDArray[np.float32] | None
    lies: BodyFrame | None = None

    def coordinates(self, drawn: DrawnBody) -> NDArray[np.float32]:
        """Flat coordinates (3 p,) of the drawn vertices, local units."""
        return drawn.rest if self.moved is None else drawn.rest + self.moved


@dataclass(eq=False)
class AnimatedPress:
    """Press of a body that may move by objects that move; goes on from the last frame while these
    keep their shapes, and begins anew where they do not.
    """

    thing: bpy.types.Object
    drawn: DrawnBody
    shape: Shape
    _pressers: list[Presser] = field(default_factory=list)
    _press: Press | None = None

    def now(self, graph: bpy.types.Depsgraph) -> PressedFrame:
        """Result of the scene as a graph has it.

        Raises
        ------
        PalpateError
            A presser cannot press, nothing leads one, their forces do not settle, or the object
            is scaled otherwise here.
        """
        chosen = self.thing.palpate
        self.drawn = held(self.thing, self.drawn)
        self._go_along(graph)
        found = pressers_of(self.thing, graph, self.drawn)
        if self._press is None or not same_tools(found, self._pressers):
            settings = ContactSettings(chosen.young_modulus, chosen.static_friction)
            self._press = Press(self.drawn.body, [one.tool for one in found], settings)
            self._pressers = found
        frames = [self._frame_at(one, graph) for one in found]
        touches = self._press.to(
            [one.pose(frame) for one, frame in zip(found, frames, strict=True)]
        )
        loads, moved = loads_of(touches), None
        if loads:
            met = settled(self.drawn.body, self.shape, loads, chosen.young_modulus)
            touches = felt(self.shape, touches, chosen.young_modulus).touches
            moved = self.drawn.drawn_displacement(met.displacements, pressing_tools(touches))
        forces = [
            frame.turn_to_world(made.force) for frame, made in zip(frames, touches, strict=True)
        ]
        return PressedFrame(graph.scene.frame_current, touches, np.array(forces), moved)

    def _go_along(self, graph: bpy.types.Depsgraph) -> None:
        """Take the body where its object is in a graph."""
        frame = frame_of(evaluated(self.thing, graph), graph.scene)
        moved = self.drawn.moved_to(frame)
        if moved is None:
            raise PalpateError(
                "{name}: in frame {frame} it is scaled otherwise than when it was made soft; "
                "remove the keyframes of its scale, or bake the frames before",
                name=self.thing.name,
                frame=graph.scene.frame_current,
            )
        self.drawn = moved

    def _frame_at(self, presser: Presser, graph: bpy.types.Depsgraph) -> BodyFrame:
        """Local frame of what is seen nearest to a presser; the body's where nothing is posed."""
        frame = self.drawn.frame
        if not place_marks.hung(self.thing):
            return frame
        return touched_place.nearest(self.thing, frame, presser.place, graph).frame(frame)


class Following(Protocol):
    """What goes through frames in their order."""

    def now(self, graph: bpy.types.Depsgraph) -> PressedFrame:
        """Result of the frame that a graph has."""


def graphs_of(scene: bpy.types.Scene, frames: Sequence[int]) -> Iterator[bpy.types.Depsgraph]:
    """The scene in each of these frames."""
    for frame in frames:
        scene.frame_set(frame)
        yield bpy.context.evaluated_depsgraph_get()


def press_frames(
    scene: bpy.types.Scene, frames: Sequence[int], press: Following
) -> Iterator[PressedFrame]:
    """Lead the pressers through these frames, one result each; errors as of `Following.now`."""
    return (press.now(graph) for graph in graphs_of(scene, frames))


class Imprinting:
    """What stays of presses of a body that yields, frame after frame: it depends on all before.

    Tools meet the surface at rest, and press it by forces of the elastic body: an imprint changes
    what is seen, not what is felt.
    """

    def __init__(self, law: Yielding, drawn: DrawnBody, frames_per_second: float) -> None:
        self._law, self._drawn, self._rate = law, drawn, frames_per_second
        self._imprint = SurfaceImprint(drawn.frame)

    def seen(self, here: PressedFrame) -> PressedFrame:
        """The next frame, with it."""
        moved = np.zeros_like(self._drawn.rest) if here.moved is None else here.moved
        seen = self._imprint.seen(self._law, moved, here.frame / self._rate)
        return replace(here, moved=seen if seen.any() else None)


def same_tools(found: Sequence[Presser], before: Sequence[Presser]) -> bool:
    """Whether pressers have the shapes that they had before."""
    return len(found) == len(before) and all(
        # Matrices are float32, so a tool that turns is never quite the same.
        _same_places(one.tool.core, other.tool.core, SAME * one.tool.radius)
        and np.isclose(one.tool.radius, other.tool.radius, rtol=SAME)
        for one, other in zip(found, before, strict=True)
    )


def _same_places(one: NDArray[np.float64], other: NDArray[np.float64], tolerance: float) -> bool:
    """Whether places (n, 3) are others (m, 3), in whatever order: that of a hull's corners changes
    with a rounding.
    """
    return all(
        np.max(cKDTree(these).query(those)[0]) <= tolerance
        for these, those in ((one, other), (other, one))
    )


@contextmanager
def frame_kept(scene: bpy.types.Scene) -> Iterator[None]:
    """The scene's frame is put back afterwards."""
    frame = scene.frame_current
    try:
        yield
    finally:
        scene.frame_set(frame)
