"""Frames of all objects kept together, and where those were that nobody holds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import tee
from operator import itemgetter

import bpy

from ...core.files.point_cache import CacheSize
from ..lying import rest_layer
from ..lying.supports import floor_of
from ..object.drawn_body import DrawnBody
from ..rest.keyed import key_places
from ..scene.body_frame import BodyFrame
from . import live_pressers
from .all_frames import Frames
from .frames.pressed_frames import PressedFrame
from .keeping import KEEPERS, Baking


def keep_all(
    things: Sequence[bpy.types.Object],
    scene: bpy.types.Scene,
    opened: Sequence[DrawnBody],
    pressed: Frames,
    keep: str,
    frames: Sequence[int],
    step: int,
) -> Baking:
    """Keep the frames of each object once all are pressed, and where it was if nobody holds it."""
    places: list[list[BodyFrame]] = [[] for _ in things]
    keepers = []
    for number, own in enumerate(tee(pressed, len(things))):
        drawn = opened[number]
        size = CacheSize(len(drawn.rest) // 3, len(frames), frames[0], step)
        one = _noting(map(itemgetter(number), own), places[number])
        keepers.append(KEEPERS[keep](things[number], scene, drawn, one, size))
    try:
        yield from _in_step(keepers)
    finally:
        for keeper in keepers:
            keeper.close()
        # Nobody else ends it where it was not played to its end.
        pressed.close()
    for thing, drawn, here in zip(things, opened, places, strict=True):
        live_pressers.end(thing)
        if not here:
            continue
        # The cache has how it lies.
        rest_layer.remove(thing)
        if drawn.body.is_free:
            graph = bpy.context.evaluated_depsgraph_get()
            key_places(thing, frames, here, floor_of(thing, drawn, graph))
    if any(places):
        scene.frame_set(scene.frame_current)


def _in_step(keepers: Sequence[Baking]) -> Baking:
    """Have all go on together, frame by frame, until the last one is done."""
    while True:
        shares = [next(keeper, None) for keeper in keepers]
        if shares[0] is None:
            return
        yield shares[0]


def _noting(pressed: Iterator[PressedFrame], places: list[BodyFrame]) -> Iterator[PressedFrame]:
    """The frames, once the place of an object that nobody holds is noted."""
    for here in pressed:
        if here.lies is not None:
            places.append(here.lies)
        yield here
