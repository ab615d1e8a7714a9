"""Live pressers: what presses an object is followed as the animation plays or things are moved.

Each state is computed from nothing, so that frames may come in any order. It is a layer that stays
as it was last; Bake Animation keeps all frames, for files that play without Palpate.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.shape.shapes import Shape, shape
from ..layer import layers, place_marks
from ..object.drawn_body import DrawnBody, open_body
from ..scene import drawn_surface
from ..scene.object_handle import ObjectHandle
from ..session import press_session
from ..shape.drawn_shape import chosen_shape
from ..traction import layer_traction
from ..traction.drawn_traction import patches_of, tractions_of
from . import frame_keys, mesh_cache
from .pressed_frames import AnimatedPress

LAYER_NAME = "Palpate Pressers"


@dataclass(eq=False)
class _Followed:
    """Body of an object whose pressers are followed, and where they were."""

    drawn: DrawnBody
    shape: Shape
    known: tuple[object, ...]
    places: NDArray[np.float32] | None = None


_followed: dict[int, _Followed] = {}
_problems: dict[int, str] = {}
# Number of objects when those with pressers were looked for, and these.
_known: tuple[int, tuple[ObjectHandle, ...]] | None = None
_paused = False


def problem_of(thing: bpy.types.Object) -> str:
    """Why an object does not follow its pressers; empty where it does."""
    return _problems.get(thing.session_uid, "")


def follow_all(scene: bpy.types.Scene) -> None:
    """Let all objects of a scene follow their pressers."""
    for handle in _pressed():
        thing = handle.find()
        if thing is not None and thing.palpate.pressers is not None and thing.name in scene.objects:
            follow(thing, scene)


def follow(thing: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Press an object as its pressers do now, unless they are where they were."""
    _problems.pop(thing.session_uid, None)
    if _paused or press_session.current() is not None or not _can_be_written(thing):
        return
    if thing.palpate.pressers is None or mesh_cache.plays(thing) or frame_keys.plays(thing):
        end(thing)
        return
    try:
        # To read a body may evaluate the object, which calls handlers.
        with paused():
            _press(thing, scene)
    except PalpateError as problem:
        # A handler has no report: the panel shows it.
        _problems[thing.session_uid] = problem.sentence
        _drop(thing.session_uid)


def press_again(thing: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Follow what presses an object, also where nothing has moved."""
    _drop(thing.session_uid)
    follow(thing, scene)


@contextmanager
def paused() -> Iterator[None]:
    """Nothing follows meanwhile, whatever frame is shown."""
    global _paused  # noqa: PLW0603  handlers ask it
    _paused = True
    try:
        yield
    finally:
        _paused = False


def end(thing: bpy.types.Object) -> None:
    """Remove the layer of an object's pressers. Safe without one."""
    _drop(thing.session_uid)
    layer = _layer(thing)
    if layer is not None:
        layers.remove(thing, layer)
        place_marks.remove(thing)


def forget() -> None:
    """Open all bodies anew: another file, or undo."""
    for uid in list(_followed):
        _drop(uid)
    _problems.clear()
    look_again()


def look_again() -> None:
    """Another object may have pressers now."""
    global _known  # noqa: PLW0603  see _pressed
    _known = None


def _pressed() -> tuple[ObjectHandle, ...]:
    """Objects with pressers, looked for only once there are more or fewer objects: this is asked at
    every move.
    """
    global _known  # noqa: PLW0603  handlers ask it
    count = len(bpy.data.objects)
    if _known is None or _known[0] != count:
        found = tuple(
            ObjectHandle.of(thing)
            for thing in bpy.data.objects
            if thing.type == "MESH" and thing.palpate.pressers is not None
        )
        _known = count, found
    return _known[1]


def _press(thing: bpy.types.Object, scene: bpy.types.Scene) -> None:
    followed = _opened(thing, scene)
    places = _places(thing)
    posed = place_marks.needed(thing)
    if not posed and followed.places is not None and np.array_equal(places, followed.places):
        return
    if posed and not place_marks.hung(thing):
        place_marks.hang(thing, LAYER_NAME)
        bpy.context.view_layer.update()
    followed.places = places
    pressed = AnimatedPress(thing, scene, followed.drawn, followed.shape).now()
    layer = _layer(thing) or layers.add(thing, LAYER_NAME)
    drawn = followed.drawn
    moved = np.zeros_like(drawn.rest) if pressed.moved is None else pressed.moved
    layers.write(thing, layer, moved)
    borne = tractions_of(thing, drawn, moved, patches_of(pressed.fingers))
    layer_traction.write_of(thing, layer, borne)


def _opened(thing: bpy.types.Object, scene: bpy.types.Scene) -> _Followed:
    """The object's body, read again only once it, its material or its shape is another one."""
    chosen = thing.palpate
    known = (
        chosen.body_key,
        len(layers.drawn_mesh(thing).vertices),
        chosen_shape(thing),
        chosen.young_modulus,
        chosen.static_friction,
    )
    followed = _followed.get(thing.session_uid)
    moved = None
    if followed is not None and followed.known == known:
        moved = followed.drawn.moved_to(drawn_surface.frame_of(thing, scene))
    if followed is None or moved is None:
        _drop(thing.session_uid)
        drawn = open_body(thing, scene)
        followed = _Followed(drawn, shape(drawn.body, chosen_shape(thing), drawn.file), known)
        _followed[thing.session_uid] = followed
    else:
        followed.drawn = moved
    return followed


def _places(thing: bpy.types.Object) -> NDArray[np.float32]:
    """Poses of the object and of all that presses it."""
    movers = [thing, *thing.palpate.pressers.all_objects]
    return np.array([one.matrix_world for one in movers], dtype=np.float32)


def _layer(thing: bpy.types.Object) -> bpy.types.NodesModifier | None:
    layer = thing.modifiers.get(LAYER_NAME)
    return layer if layer is not None and layers.is_layer(layer) else None


def _can_be_written(thing: bpy.types.Object) -> bool:
    return bool(thing.mode == "OBJECT" and thing.is_editable and thing.data.is_editable)


def _drop(uid: int) -> None:
    followed = _followed.pop(uid, None)
    if followed is not None:
        followed.shape.close()
