"""Ways to keep the frames of an animation so that they play without Palpate."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from functools import partial
from pathlib import Path

import bpy

from ...core.files.point_cache import CacheSize, point_cache
from ...core.files.scratch_folder import ScratchFolder
from ..object.drawn_body import DrawnBody
from ..played import cache_place, mesh_cache
from ..traction.drawn_traction import patches_of, tractions_of
from ..traction.frame_tractions import FrameTractions, frame_tractions
from . import exchange_file, frame_keys, live_pressers
from .exchange_file import Exchange
from .frames.pressed_frames import PressedFrame

Baking = Generator[float, None, None]
"""Share of the frames that are pressed, after each."""
Keeper = Callable[
    [bpy.types.Object, bpy.types.Scene, DrawnBody, Iterator[PressedFrame], CacheSize], Baking
]
"""Keeps all frames once the last is pressed; nothing, if it is closed before."""

SCRATCH_WORD = "animation"


def _as_cache(
    thing: bpy.types.Object,
    _: bpy.types.Scene,
    drawn: DrawnBody,
    pressed: Iterator[PressedFrame],
    size: CacheSize,
) -> Baking:
    place = cache_place.place_for(thing, cache_place.CACHE_SUFFIX)
    yield from _written(place, drawn, pressed, size)
    mesh_cache.play(thing, place, size)


def _as_keys(
    thing: bpy.types.Object,
    _: bpy.types.Scene,
    drawn: DrawnBody,
    pressed: Iterator[PressedFrame],
    size: CacheSize,
) -> Baking:
    kept = yield from collected(pressed, size.samples)
    frame_keys.keep_frames(thing, drawn, kept)


def _as_exchange(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    drawn: DrawnBody,
    pressed: Iterator[PressedFrame],
    size: CacheSize,
    *,
    kind: Exchange,
) -> Baking:
    target = cache_place.place_for(thing, kind.value)
    with (
        ScratchFolder(SCRATCH_WORD) as folder,
        frame_tractions(folder.path / "forces", size.points, size.first_frame, size.step) as forces,
    ):
        frames = folder.path / "frames.pc2"
        told = kind.holds_attributes and thing.palpate.force_attributes
        if told:
            pressed = _noted(thing, drawn, pressed, forces)
        yield from _written(frames, drawn, pressed, size)
        with live_pressers.paused():
            path = exchange_file.write(
                thing, scene, frames, size, target, kind, forces if told else None
            )
    exchange_file.play(thing, target, path, attributes=told)


def _noted(
    thing: bpy.types.Object,
    drawn: DrawnBody,
    pressed: Iterator[PressedFrame],
    forces: FrameTractions,
) -> Iterator[PressedFrame]:
    """The frames, once what each of them bears is stored."""
    for here in pressed:
        borne = None
        if here.moved is not None:
            borne = tractions_of(thing, drawn, here.moved, patches_of(here.fingers))
        forces.add(here.moved, borne)
        yield here


def _written(
    place: Path, drawn: DrawnBody, pressed: Iterator[PressedFrame], size: CacheSize
) -> Baking:
    """Write all frames to a point cache."""
    with point_cache(place, size) as cache:
        for here in pressed:
            cache.write(here.coordinates(drawn))
            yield cache.written / size.samples


KEEPERS: dict[str, Keeper] = {
    "CACHE": _as_cache,
    "KEYS": _as_keys,
    "ALEMBIC": partial(_as_exchange, kind=Exchange.ALEMBIC),
    "USD": partial(_as_exchange, kind=Exchange.USD),
}
ITEMS = [
    ("CACHE", "Mesh Cache", "A PC2 file beside the .blend, played by a modifier"),
    ("KEYS", "Shape Keys", "A shape key a frame, within the .blend"),
    *(
        (kind.name, name, "A file beside the .blend for other programs, played by a modifier")
        for kind, name in ((Exchange.ALEMBIC, "Alembic"), (Exchange.USD, "USD"))
        if kind.is_built_in
    ),
]


def collected(
    pressed: Iterator[PressedFrame], count: int
) -> Generator[float, None, list[PressedFrame]]:
    """All frames, once each share of them was told."""
    kept: list[PressedFrame] = []
    for here in pressed:
        kept.append(here)
        yield len(kept) / count
    return kept
