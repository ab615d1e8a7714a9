"""Mesh Cache: the modifier that plays an animation's file, also without Palpate."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy

from ...core.errors import PalpateError
from ...core.files.point_cache import CacheSize
from ..layer import layers
from ..layer.stack import PLAYERS
from ..object import body_store

MODIFIER_NAME = "Palpate Animation"


def place_for(thing: bpy.types.Object, suffix: str, is_own: Callable[[Path], bool]) -> Path:
    """Where the object's animation is written: beside its body file,
    ``<.blend>-<object>-animation`` and suffix.

    Nothing is there, or what is Palpate's own and only this object plays; if anything else is, the
    next name is taken. Another object, or another .blend of the folder, keeps its animation so.

    Raises
    ------
    PalpateError
        There is no .blend yet; the folder beside it leads elsewhere.
    """
    if not bpy.data.filepath:
        raise PalpateError(
            "{name}: its animation becomes a file beside the .blend, and this is not saved yet; "
            "save it first, or keep the animation as Shape Keys",
            name=thing.name,
        )
    folder = body_store.folder_for_new_files()
    word = bpy.path.clean_name(f"{Path(bpy.data.filepath).stem}-{thing.name}")
    names = itertools.chain(
        (f"{word}-animation{suffix}",),
        (f"{word}-animation-{n}{suffix}" for n in itertools.count(2)),
    )
    places = (folder / name for name in names)
    return next(
        place
        for place in places
        if not os.path.lexists(place) or (is_own(place) and _players(place) == [thing])
    )


def _players(file: Path) -> list[bpy.types.Object]:
    """Objects that play a file."""
    found = file.resolve()
    return [one for one in bpy.data.objects if _played(one) == found]


def _played(thing: bpy.types.Object) -> Path | None:
    """File that the object's modifier plays, shown or not."""
    modifier = thing.modifiers.get(MODIFIER_NAME)
    holder = getattr(modifier, "cache_file", modifier)
    # The one has its path itself, the other the path of a data-block.
    if modifier is None or modifier.type not in PLAYERS or holder is None or not holder.filepath:
        return None
    library = getattr(holder, "library", thing.library)
    return Path(bpy.path.abspath(holder.filepath, library=library)).resolve()


def plays(thing: bpy.types.Object) -> bool:
    """Whether the object's modifier plays a cache now."""
    modifier = thing.modifiers.get(MODIFIER_NAME)
    return modifier is not None and modifier.type in PLAYERS and modifier.show_viewport


@contextmanager
def silent(thing: bpy.types.Object) -> Iterator[None]:
    """The object's modifier plays nothing meanwhile."""
    played = plays(thing)
    if played:
        thing.modifiers[MODIFIER_NAME].show_viewport = False
    try:
        yield
    finally:
        if played:
            thing.modifiers[MODIFIER_NAME].show_viewport = True


def play(thing: bpy.types.Object, cache: Path, size: CacheSize) -> bpy.types.Modifier:
    """Let the object's modifier play a cache, before all that deforms the mesh further."""
    modifier = modifier_of(thing, "MESH_CACHE")
    modifier.cache_format = "PC2"
    modifier.filepath = shortest(cache)
    modifier.deform_mode = "OVERWRITE"
    modifier.interpolation = "LINEAR"
    modifier.play_mode, modifier.time_mode = "SCENE", "FRAME"
    # Blender takes the start off the frame only once that is scaled.
    modifier.frame_start, modifier.frame_scale = size.first_frame / size.step, 1.0 / size.step
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"
    return modifier


def modifier_of(thing: bpy.types.Object, kind: str) -> bpy.types.Modifier:
    """The modifier that plays an object's animation, right behind what makes its vertices; another
    kind is replaced.
    """
    modifier = thing.modifiers.get(MODIFIER_NAME)
    if modifier is not None and modifier.type in PLAYERS and modifier.type != kind:
        thing.modifiers.remove(modifier)
        modifier = None
    if modifier is None or modifier.type != kind:
        modifier = thing.modifiers.new(MODIFIER_NAME, kind)
    thing.modifiers.move(thing.modifiers.find(modifier.name), layers.place_of_vertices(thing))
    return modifier


def shortest(path: Path) -> str:
    """Relative to the .blend where it is beside it."""
    blend = Path(bpy.data.filepath)
    if bpy.data.filepath and path.is_relative_to(blend.parent):
        return f"//{path.relative_to(blend.parent).as_posix()}"
    return str(path)
