"""Frames of all objects that are baked together, in their order."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import ExitStack, contextmanager

import bpy

from ...core.errors import PalpateError
from ...core.shape.shapes import Shape
from ..imprint.surface_imprint import yielding_of
from ..layer import place_marks, stack
from ..object.drawn_body import DrawnBody
from ..played import mesh_cache
from ..shape.drawn_shape import closing_shape
from . import frame_keys, live_pressers
from .force_table import FrameRows
from .frames.lying_frames import LyingFrames
from .frames.piled_frames import PiledFrames
from .frames.pressed_frames import (
    AnimatedPress,
    Following,
    Imprinting,
    PressedFrame,
    frame_kept,
    graphs_of,
    press_frames,
)

Frames = Generator[tuple[PressedFrame, ...], None, None]
"""Of each frame what came of it for each object."""


def all_frames(
    things: Sequence[bpy.types.Object],
    scene: bpy.types.Scene,
    opened: Sequence[DrawnBody],
    frames: Sequence[int],
    step: int,
    rows: FrameRows,
    warn: Callable[[str], None],
) -> Frames:
    """Lead what presses objects through frames; ``rows`` get those of the first one.

    Raises
    ------
    PalpateError
        Something cannot press or be pressed, or nothing touches anything.
    """
    touched, rate = False, scene.render.fps / scene.render.fps_base
    with (
        live_pressers.paused(),
        _met_as_seen(things),
        frame_kept(scene),
        closing_shape(things[0], opened[0]) as shape,
    ):
        imprints = [
            Imprinting(yielding_of(thing, drawn.frame), drawn, rate)
            for thing, drawn in zip(things, opened, strict=True)
        ]
        for pressed in _followed(things, scene, opened, frames, step / rate, shape):
            seen = tuple(map(Imprinting.seen, imprints, pressed))
            rows.add(seen[0])
            touched |= any(here.moved is not None for here in seen)
            yield seen
        if shape.notice:
            warn(shape.notice)
    if not touched:
        raise PalpateError(
            "The tool touches nothing in these frames; move its keyframes to the surface"
        )


def _followed(
    things: Sequence[bpy.types.Object],
    scene: bpy.types.Scene,
    opened: Sequence[DrawnBody],
    frames: Sequence[int],
    seconds: float,
    shape: Shape,
) -> Iterator[tuple[PressedFrame, ...]]:
    if len(things) > 1:
        piled = PiledFrames(things, opened, seconds)
        yield from (piled.now(graph) for graph in graphs_of(scene, frames))
        return
    (thing,), (drawn,) = things, opened
    following: Following = AnimatedPress(thing, drawn, shape)
    if drawn.body.is_free:
        following = LyingFrames(thing, drawn, seconds)
    for here in press_frames(scene, frames, following):
        yield (here,)


@contextmanager
def _met_as_seen(things: Sequence[bpy.types.Object]) -> Iterator[None]:
    """Bodies are met where they are seen, but for what an earlier bake or live pressers show."""
    names = mesh_cache.MODIFIER_NAME, live_pressers.LAYER_NAME
    with ExitStack() as all_of:
        for thing in things:
            if not frame_keys.plays(thing):
                all_of.enter_context(stack.silent(thing, *names))
                all_of.enter_context(place_marks.marked(thing))
        yield
