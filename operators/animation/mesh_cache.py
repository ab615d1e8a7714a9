"""Mesh Cache: the modifier that plays an animation's point cache, also without Palpate."""

from __future__ import annotations

import itertools
from pathlib import Path

import bpy

from ...core.files.point_cache import CacheSize, is_own_cache
from ..object import body_store

MODIFIER_NAME = "Palpate Animation"


def place_for(thing: bpy.types.Object) -> Path:
    """Where the object's cache is written: beside its body file, ``<object>-animation.pc2``.

    Nothing is there, or a cache of Palpate's; if something else is, the next name is taken.

    Raises
    ------
    PalpateError
        The folder beside the .blend leads elsewhere.
    """
    folder, word = body_store.folder_for_new_files(), bpy.path.clean_name(thing.name)
    names = itertools.chain(
        (f"{word}-animation.pc2",), (f"{word}-animation-{n}.pc2" for n in itertools.count(2))
    )
    places = (folder / name for name in names)
    return next(place for place in places if not place.exists() or is_own_cache(place))


def plays(thing: bpy.types.Object) -> bool:
    """Whether the object's modifier plays a cache now."""
    modifier = thing.modifiers.get(MODIFIER_NAME)
    return modifier is not None and modifier.type == "MESH_CACHE" and modifier.show_viewport


def play(thing: bpy.types.Object, cache: Path, size: CacheSize) -> bpy.types.Modifier:
    """Let the object's modifier play a cache, before all that deforms the mesh further."""
    modifier = thing.modifiers.get(MODIFIER_NAME)
    if modifier is None or modifier.type != "MESH_CACHE":
        modifier = thing.modifiers.new(MODIFIER_NAME, "MESH_CACHE")
    thing.modifiers.move(thing.modifiers.find(modifier.name), 0)
    modifier.cache_format = "PC2"
    modifier.filepath = _shortest(cache)
    modifier.deform_mode = "OVERWRITE"
    modifier.interpolation = "LINEAR"
    modifier.play_mode, modifier.time_mode = "SCENE", "FRAME"
    # Blender takes the start off the frame only once that is scaled.
    modifier.frame_start, modifier.frame_scale = size.first_frame / size.step, 1.0 / size.step
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"
    return modifier


def _shortest(path: Path) -> str:
    """Relative to the .blend where it is beside it."""
    blend = Path(bpy.data.filepath)
    if bpy.data.filepath and path.is_relative_to(blend.parent):
        return f"//{path.relative_to(blend.parent).as_posix()}"
    return str(path)
