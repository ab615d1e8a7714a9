"""Live pressers: what presses an object is followed as the animation plays or things are moved.

Each state is computed from nothing, so that frames may come in any order. It is a layer that stays
as it was last; Bake Animation keeps all frames, for files that play without Palpate.

Places are those of the dependency graph that calls: in a render the originals do not move. Handlers
call, so nothing is baked and no file is written but where somebody has just asked for it, and what
fails is not tried again until something that it depends on has changed.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.shape.shapes import Shape, shape
from ..carrier import changing
from ..layer import imprints, layers, place_marks
from ..object import body_store
from ..object.drawn_body import DrawnBody, open_body
from ..place.evaluation import evaluated
from ..played import mesh_cache
from ..scene import drawn_surface
from ..scene.object_handle import ObjectHandle
from ..session import press_session
from ..shape.drawn_shape import chosen_shape
from ..traction import layer_traction
from ..traction.drawn_traction import patches_of, tractions_of
from . import failures, frame_keys
from .failures import Attempt
from .frames.pressed_frames import AnimatedPress

LAYER_NAME = layers.PRESSERS_NAME


@dataclass(eq=False)
class _Followed:
    """Body of an object whose pressers are followed, and where they were."""

    drawn: DrawnBody
    shape: Shape
    known: tuple[object, ...]
    places: NDArray[np.float32] | None = None


_followed: dict[int, _Followed] = {}
# Number of objects when those with pressers were looked for, and these.
_known: tuple[int, tuple[ObjectHandle, ...]] | None = None
_paused = False


def follow_all(graph: bpy.types.Depsgraph) -> None:
    """Let all objects of a graph's scene follow their pressers; none stops those after it.

    Raises
    ------
    ExceptionGroup
        What nobody expected.
    """
    if changing.is_aside(graph.scene):
        return
    unexpected = []
    for handle in _pressed():
        thing = handle.find()
        if thing is None or thing.palpate.pressers is None:
            continue
        if thing.name not in graph.scene.objects:
            continue
        try:
            follow(thing, graph)
        except Exception as bug:  # noqa: BLE001  raised once the others have followed
            unexpected.append(bug)
    if unexpected:
        message = "some objects do not follow their Pressers"
        raise ExceptionGroup(message, unexpected)


def follow(thing: bpy.types.Object, graph: bpy.types.Depsgraph, *, asked: bool = False) -> None:
    """Press an object as its pressers do in a graph, unless they are where they were. A missing
    body is computed only where somebody has ``asked``.
    """
    if _paused or press_session.current() is not None or not _can_be_written(thing):
        return
    if thing.palpate.pressers is None or mesh_cache.plays(thing) or frame_keys.plays(thing):
        if not _is_unlocked(graph):
            end(thing)
        return
    attempt = _attempt(thing, graph)
    if failures.is_known(thing, attempt):
        return
    try:
        # To read a body may evaluate the object, which calls handlers.
        with paused():
            _press(thing, graph, attempt.places, asked=asked)
    except Exception as problem:
        if thing.session_uid not in _followed:
            # Where its pressers are does not matter to an object that was not opened.
            attempt = replace(attempt, places=attempt.places[:1])
        failures.remember(thing, attempt, problem, aloud=graph.mode == "RENDER")
        _drop(thing.session_uid)
        if not isinstance(problem, PalpateError):
            raise
    else:
        failures.forget(thing)


def changed(graph: bpy.types.Depsgraph) -> None:
    """Press again, at the next move, what is pressed by objects of another geometry; and try again
    what failed and is another one itself.
    """
    if _paused:
        return
    uids = {one.id.original.session_uid for one in graph.updates if one.is_updated_geometry}
    for handle in _pressed() if uids else ():
        thing = handle.find()
        if thing is None or thing.palpate.pressers is None:
            continue
        pressed_by = {one.session_uid for one in thing.palpate.pressers.all_objects}
        followed = _followed.get(thing.session_uid)
        # What is pressed has another geometry each time it follows.
        if followed is not None and uids & pressed_by:
            followed.places = None
        if uids & {thing.session_uid, *pressed_by}:
            failures.forget(thing)


def press_again(thing: bpy.types.Object, graph: bpy.types.Depsgraph) -> None:
    """Follow what presses an object as somebody has asked, also where nothing has moved."""
    _drop(thing.session_uid)
    failures.forget(thing)
    follow(thing, graph, asked=True)


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
    failures.forget(thing)
    layer = _layer(thing)
    if layer is not None:
        layers.remove(thing, layer)
        place_marks.remove(thing)


def forget() -> None:
    """Open all bodies anew: another file, or undo."""
    for uid in list(_followed):
        _drop(uid)
    failures.forget_all()
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


def _is_unlocked(graph: bpy.types.Depsgraph) -> bool:
    """Whether the window may be reading, at this moment, what would be written for a render."""
    beside = threading.current_thread() is not threading.main_thread()
    return beside and not graph.scene.render.use_lock_interface


def _press(
    thing: bpy.types.Object,
    graph: bpy.types.Depsgraph,
    places: NDArray[np.float32],
    *,
    asked: bool,
) -> None:
    if _is_unlocked(graph):
        raise PalpateError(
            "a render beside the window does not follow Pressers; tick Lock Interface here or in "
            "the menu Render, or press Bake Animation"
        )
    followed = _opened(thing, graph, asked=asked)
    posed = place_marks.needed(thing)
    if not posed and followed.places is not None and np.array_equal(places, followed.places):
        return
    if posed and not place_marks.hung(thing):
        if graph.mode == "RENDER":
            raise PalpateError(
                "{name}: its pose is not marked yet; show a frame before you render, and save, or "
                "press Bake Animation",
                name=thing.name,
            )
        place_marks.hang(thing, LAYER_NAME)
        bpy.context.view_layer.update()
    followed.places = places
    pressed = AnimatedPress(thing, followed.drawn, followed.shape).now(graph)
    layer = _layer(thing) or layers.add(thing, LAYER_NAME)
    drawn = followed.drawn
    moved = np.zeros_like(drawn.rest) if pressed.moved is None else pressed.moved
    layers.write(thing, layer, moved)
    borne = tractions_of(thing, drawn, moved, patches_of(pressed.fingers))
    layer_traction.write_of(thing, layer, borne)


def _opened(thing: bpy.types.Object, graph: bpy.types.Depsgraph, *, asked: bool) -> _Followed:
    """The object's body, read again only once it, its material or its shape is another one."""
    frame = drawn_surface.frame_of(evaluated(thing, graph), graph.scene)
    known, followed, moved = _known_of(thing), _followed.get(thing.session_uid), None
    if followed is not None and followed.known == known:
        moved = followed.drawn.moved_to(frame)
    if followed is None or moved is None:
        _drop(thing.session_uid)
        drawn = open_body(thing, graph.scene, as_stored=not asked)
        moved = drawn.moved_to(frame)
        if moved is None:
            raise PalpateError(
                "{name}: it is scaled otherwise in this render than in the view; press Bake "
                "Animation",
                name=thing.name,
            )
        followed = _Followed(drawn, shape(drawn.at_rest, chosen_shape(thing), drawn.file), known)
        _followed[thing.session_uid] = followed
    followed.drawn = moved
    return followed


def _known_of(thing: bpy.types.Object) -> tuple[object, ...]:
    """What the opened body of an object depends on."""
    chosen = thing.palpate
    return (
        chosen.body_key,
        len(layers.drawn_mesh(thing).vertices),
        chosen_shape(thing),
        chosen.young_modulus,
        chosen.static_friction,
        imprints.told_by(thing),
    )


def _attempt(thing: bpy.types.Object, graph: bpy.types.Depsgraph) -> Attempt:
    movers = [thing, *thing.palpate.pressers.all_objects]
    places = [one.evaluated_get(graph).matrix_world for one in movers]
    known = (
        *_known_of(thing),
        body_store.stamp(thing),
        *(one.session_uid for one in movers),
        graph.mode,
        _is_unlocked(graph),
    )
    return Attempt(known, np.array(places, dtype=np.float32))


def _layer(thing: bpy.types.Object) -> bpy.types.NodesModifier | None:
    layer = thing.modifiers.get(LAYER_NAME)
    return layer if layer is not None and layers.is_layer(layer) else None


def _can_be_written(thing: bpy.types.Object) -> bool:
    return bool(thing.mode == "OBJECT" and thing.is_editable and thing.data.is_editable)


def _drop(uid: int) -> None:
    followed = _followed.pop(uid, None)
    if followed is not None:
        followed.shape.close()
