"""Mesh Cache: the modifier that plays an animation's file, also without Palpate."""

from __future__ import annotations

from pathlib import Path

import bpy

from ...core.files.point_cache import CacheSize
from ..layer import layers
from ..layer.stack import PLAYERS

MODIFIER_NAME = "Palpate Animation"


def plays(thing: bpy.types.Object) -> bool:
    """Whether the object's modifier plays a cache now."""
    modifier = thing.modifiers.get(MODIFIER_NAME)
    return modifier is not None and modifier.type in PLAYERS and modifier.show_viewport


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
