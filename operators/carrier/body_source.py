"""Surface that a body is baked from: the object's mesh, or the mesh as seen."""

from __future__ import annotations

import bpy
import numpy as np

from ...core.errors import PalpateError
from ..layer import layers, stack
from ..scene import drawn_surface
from ..scene.drawn_surface import DrawnSurface
from ..scene.fingerprint import Fingerprint
from . import changing, seen_mesh

# Relative difference of two meshes that are the same.
SAME = 1e-6


def read(thing: bpy.types.Object, scene: bpy.types.Scene) -> DrawnSurface:
    """Read the surface to bake: as seen where modifiers make vertices, unless the object's settings
    ask for its own mesh.

    Raises
    ------
    PalpateError
        The modifiers make other vertices in other frames, or no faces, or nothing evaluates them;
        the transform flattens it.
    """
    own = drawn_surface.read(thing, scene)
    if thing.palpate.bake_from == "BASE" or not stack.making(thing):
        return own
    changing.refuse(thing, scene)
    seen = seen_mesh.read(thing, scene)
    return own if _same(own, seen) else seen


def read_again(thing: bpy.types.Object, scene: bpy.types.Scene) -> DrawnSurface:
    """Read the surface that the object's body was baked from, as it is now.

    Raises
    ------
    PalpateError
        The modifiers make another number of vertices than when it was baked, or nothing evaluates
        them; the transform flattens it.
    """
    if not is_seen(thing):
        return drawn_surface.read(thing, scene)
    surface, on = seen_mesh.read(thing, scene), layers.carrier(thing)
    baked = layers.seen_count(on)
    if on is not None and surface.stack == _recorded(thing) and len(surface.local) != baked:
        raise PalpateError(
            "{name}: its modifiers make {now} vertices in this frame, {then} when it was baked; "
            "press in a frame where they make as many, or apply them",
            name=thing.name,
            now=len(surface.local),
            then=baked,
        )
    return surface


def is_seen(thing: bpy.types.Object) -> bool:
    """Whether the object's body was baked from the mesh as seen."""
    return bool(thing.palpate.body_key) and bool(_recorded(thing))


def _recorded(thing: bpy.types.Object) -> str:
    try:
        return Fingerprint.from_text(thing.palpate.fingerprint).stack
    except PalpateError:
        # The status says what is wrong with it.
        return ""


def _same(own: DrawnSurface, seen: DrawnSurface) -> bool:
    alike = own.local.shape == seen.local.shape
    return alike and bool(
        np.abs(own.local - seen.local).max() <= SAME * np.ptp(own.local, axis=0).max()
    )
