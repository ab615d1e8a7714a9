"""Layer that follows a press: added, written each frame, then kept or removed.

All else of the object and its mesh stays as it is, bit for bit.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..scene.active_object import chosen_alone
from . import layers, place_marks
from .layer_groups import TRACTION
from .layers import LIVE_NAME

GOING_ON = "A press is going on; Enter keeps the shape, Escape restores it"


def hang(thing: bpy.types.Object) -> None:
    """Add the live layer, and the marks by which its places are found."""
    remove(thing)
    place_marks.hang(thing, LIVE_NAME)
    layers.add(thing, LIVE_NAME)


def write(thing: bpy.types.Object, vectors: NDArray[np.float32]) -> None:
    """Write flat float32 displacements (3 p,), local units, and redraw; nothing without a layer."""
    live = find(thing)
    if live is not None:
        layers.write(thing, live, vectors)


def keep(thing: bpy.types.Object) -> str:
    """Turn the live layer into the next free "Press <n>"; returns its name."""
    live = find(thing)
    if live is None:
        raise RuntimeError(f"{thing.name} has no live layer to keep")
    place_marks.remove(thing)
    return layers.keep(thing, live)


def remove(thing: bpy.types.Object) -> None:
    """Remove the live layer, or what is left of it. Safe without one."""
    live = find(thing)
    if live is not None:
        layers.remove(thing, live)
    place_marks.remove(thing)
    mesh = layers.drawn_mesh(thing)
    for name in (LIVE_NAME, LIVE_NAME + TRACTION):
        remains = mesh.attributes.get(name)
        if remains is not None:
            mesh.attributes.remove(remains)


def find(thing: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """The live layer, if there is one."""
    live = thing.modifiers.get(LIVE_NAME)
    return live if live is not None and layers.is_layer(live) else None


def refusal(thing: bpy.types.Object | None) -> str:
    """Reason why an object's layers stay as they are now: it is being pressed; empty if not."""
    return "" if thing is None or find(thing) is None else GOING_ON


def remove_leftovers() -> None:
    """Remove live layers from all objects: undo and autosave may bring one back."""
    # Of thousands few have modifiers, and a layer is one.
    for thing in [one for one in bpy.data.objects if one.modifiers]:
        if thing.type == "MESH" and thing.is_editable and thing.data.is_editable:
            remove(thing)


def leave_edit_mode(thing: bpy.types.Object) -> None:
    """Leave edit mode, in which attributes cannot be removed; not that of another scene, which no
    operator leaves.
    """
    if thing.mode == "OBJECT" or thing not in bpy.context.view_layer.objects.values():
        return
    with chosen_alone(thing):
        bpy.ops.object.mode_set(mode="OBJECT")
