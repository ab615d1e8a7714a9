"""Shape key that follows a press: added, written each frame, then kept or removed.

Other shape keys, the active one, and the mesh itself stay as they are, bit for bit.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

LIVE_NAME = "Palpate live"
BASIS_NAME = "Basis"
KEPT_NAME = "Press"
# Custom property with the state before the press, for a clean-up after undo or a crash.
FOUND_MARK = "palpate_found"


@dataclass(frozen=True)
class FoundKeys:
    """State of the object's shape keys before a press."""

    had_basis: bool
    active_index: int
    showed_only_one: bool

    @classmethod
    def of(cls, thing: bpy.types.Object) -> FoundKeys:
        """Present state."""
        return cls(
            thing.data.shape_keys is not None,
            thing.active_shape_key_index,
            thing.show_only_shape_key,
        )

    def put_back(self, thing: bpy.types.Object) -> None:
        """Restore the active key, and whether it is shown alone."""
        thing.show_only_shape_key = self.showed_only_one
        thing.active_shape_key_index = self.active_index


def hang(thing: bpy.types.Object) -> None:
    """Add the live shape key at full value, and a Basis where there was none."""
    found = FoundKeys.of(thing)
    if not found.had_basis:
        thing.shape_key_add(name=BASIS_NAME, from_mix=False)
    live = thing.shape_key_add(name=LIVE_NAME, from_mix=False)
    live.relative_key = thing.data.shape_keys.reference_key
    live.value = 1.0
    thing.data.shape_keys[FOUND_MARK] = [
        int(found.had_basis),
        found.active_index,
        int(found.showed_only_one),
    ]
    # An active key that is shown alone would hide the live one.
    thing.show_only_shape_key = False


def write(mesh: bpy.types.Mesh, coordinates: NDArray[np.float32]) -> None:
    """Write flat float32 coordinates (3 p,) into the live shape key and redraw."""
    live = _live(mesh)
    if live is not None:
        live.points.foreach_set("co", coordinates)
        mesh.update()


def remove(thing: bpy.types.Object) -> None:
    """Remove the live shape key, and the Basis if it came with it. Safe without one."""
    live = _live(thing.data)
    if live is None:
        return
    found = _found(thing.data)
    thing.shape_key_remove(live)
    keys = thing.data.shape_keys
    if keys is not None and not found.had_basis and len(keys.key_blocks) == 1:
        thing.shape_key_remove(keys.reference_key)
    elif keys is not None and FOUND_MARK in keys:
        del keys[FOUND_MARK]
    found.put_back(thing)
    thing.data.update()


def keep(thing: bpy.types.Object) -> str:
    """Turn the live shape key into the next free "Press <n>"; returns its name."""
    keys = thing.data.shape_keys
    live = keys.key_blocks[LIVE_NAME]
    found = _found(thing.data)
    number = 1
    while f"{KEPT_NAME} {number}" in keys.key_blocks:
        number += 1
    live.name = f"{KEPT_NAME} {number}"
    del keys[FOUND_MARK]
    found.put_back(thing)
    thing.active_shape_key_index = len(keys.key_blocks) - 1
    return live.name


def remove_leftovers() -> None:
    """Remove live shape keys from all objects: undo and autosave may bring one back."""
    for thing in bpy.data.objects:
        if thing.type == "MESH" and thing.is_editable and _live(thing.data) is not None:
            remove(thing)


def _live(mesh: bpy.types.Mesh) -> bpy.types.ShapeKey | None:
    return mesh.shape_keys.key_blocks.get(LIVE_NAME) if mesh.shape_keys else None


def _found(mesh: bpy.types.Mesh) -> FoundKeys:
    mark = mesh.shape_keys.get(FOUND_MARK)
    # A stranger's file may hold anything under this name.
    if getattr(mark, "typecode", "") != "i" or len(mark) != 3:
        return FoundKeys(had_basis=True, active_index=0, showed_only_one=False)
    had_basis, active_index, showed_only_one = mark
    within = min(max(active_index, 0), len(mesh.shape_keys.key_blocks) - 1)
    return FoundKeys(bool(had_basis), within, bool(showed_only_one))


def leave_edit_mode(thing: bpy.types.Object) -> None:
    """Leave edit mode, in which shape keys cannot be removed."""
    if thing.mode == "OBJECT":
        return
    with bpy.context.temp_override(active_object=thing, object=thing):
        bpy.ops.object.mode_set(mode="OBJECT")
