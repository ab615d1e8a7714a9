"""Attributes of layers and rigs in a mesh: noted there, so that none is left once nothing shows it.

A modifier that is deleted in Blender's own stack leaves its attributes behind. What a user made is
never noted, and stays.
"""

from __future__ import annotations

import bpy

from . import modifier_inputs
from .layer_groups import AXES, CARRIER, DISPLACEMENT, TRACTION, Kind, kind_of

# Custom property of a mesh: names of layers and rigs, a line each.
NOTE = "palpate_attributes"
SHOWING = {Kind.LAYER, Kind.FORCES, Kind.RIG}


def note(mesh: bpy.types.Mesh, name: str) -> None:
    """Note that a layer or a rig of this name has attributes in a mesh."""
    noted = _noted(mesh)
    if name and name not in noted:
        mesh[NOTE] = "\n".join([*noted, name])


def sweep(mesh: bpy.types.Mesh) -> None:
    """Remove the noted attributes that no modifier of any object shows. Safe to repeat."""
    noted = _noted(mesh)
    if not noted:
        return
    shown = _shown(mesh)
    for name in noted:
        if name in shown:
            continue
        for own in (name, name + TRACTION, *(f"{name} {axis}" for axis in AXES)):
            found = mesh.attributes.get(own)
            if found is not None and (found.data_type, found.domain) == ("FLOAT_VECTOR", "POINT"):
                mesh.attributes.remove(found)
    kept = [name for name in noted if name in shown]
    if kept:
        mesh[NOTE] = "\n".join(kept)
    else:
        del mesh[NOTE]


def _noted(mesh: bpy.types.Mesh) -> list[str]:
    text = mesh.get(NOTE)
    # A stranger's file may hold anything under this name.
    return text.split("\n") if isinstance(text, str) and text else []


def _shown(mesh: bpy.types.Mesh) -> set[object]:
    """Names that modifiers show of a mesh, which may be a carrier's."""
    return {
        modifier_inputs.value(modifier, DISPLACEMENT)
        for thing in bpy.data.objects
        for modifier in thing.modifiers
        if modifier.type == "NODES" and kind_of(modifier.node_group) in SHOWING
        if _mesh_of(thing, modifier) == mesh
    }


def _mesh_of(thing: bpy.types.Object, modifier: bpy.types.NodesModifier) -> bpy.types.ID | None:
    carrier = modifier_inputs.value(modifier, CARRIER)
    found: bpy.types.ID | None = (
        carrier.data if isinstance(carrier, bpy.types.Object) else thing.data
    )
    return found
