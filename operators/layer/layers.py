"""Layers of an object: each a modifier and the displacement of the vertices that it adds.

The displacement is a point attribute, local units, at rest: of the object's mesh, or of its carrier
where modifiers make other vertices. The mesh itself stays as it is, and layers add up in any order.
"""

from __future__ import annotations

from collections.abc import Mapping

import bpy
import numpy as np
from numpy.typing import NDArray

from . import modifier_inputs
from .layer_groups import CARRIER, DISPLACEMENT, STRENGTH, Kind, group_of, kind_of

KEPT_NAME = "Press"
# Types of modifiers that play the places of all vertices.
PLAYERS = ("MESH_CACHE", "MESH_SEQUENCE_CACHE")


def layers_of(thing: bpy.types.Object) -> list[bpy.types.NodesModifier]:
    """Modifiers of an object that are layers, in their order."""
    return [modifier for modifier in thing.modifiers if is_layer(modifier)]


def is_layer(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier is a layer."""
    return kind(modifier) is Kind.LAYER


def kind(modifier: bpy.types.Modifier) -> Kind | None:
    """What a modifier of Palpate's adds; None for all others."""
    return kind_of(modifier.node_group) if modifier.type == "NODES" else None


def add(
    thing: bpy.types.Object, name: str, carrier: bpy.types.Object | None = None
) -> bpy.types.NodesModifier:
    """Add a layer that displaces nothing yet, with its attribute on the carrier, if there is one.

    Blender gives another name where this one is taken.
    """
    mesh = thing.data if carrier is None else carrier.data
    attribute = mesh.attributes.new(name, "FLOAT_VECTOR", "POINT")
    return add_modifier(thing, name, Kind.LAYER, {DISPLACEMENT: attribute.name, CARRIER: carrier})


def add_modifier(
    thing: bpy.types.Object, name: str, added: Kind, inputs: Mapping[str, object]
) -> bpy.types.NodesModifier:
    """Add a modifier of Palpate's with values of its inputs, before all that poses the mesh."""
    modifier = thing.modifiers.new(name, "NODES")
    modifier.node_group = group_of(added)
    for given, value in inputs.items():
        modifier_inputs.set_value(modifier, given, value)
    modifier.show_expanded = False
    thing.modifiers.move(len(thing.modifiers) - 1, _place(thing, modifier))
    return modifier


def rename(thing: bpy.types.Object, layer: bpy.types.NodesModifier, name: str) -> None:
    """Rename a layer and its attribute."""
    attribute = _attribute(thing, layer)
    if attribute is not None:
        attribute.name = name
        modifier_inputs.set_value(layer, DISPLACEMENT, attribute.name)
    layer.name = name


def remove(thing: bpy.types.Object, layer: bpy.types.NodesModifier) -> None:
    """Remove a layer, and its attribute where no other layer shows it."""
    mesh, name = _mesh(thing, layer), attribute_name(layer)
    thing.driver_remove(strength_path(layer))
    thing.modifiers.remove(layer)
    shown = {
        attribute_name(other)
        for user in bpy.data.objects
        for other in layers_of(user)
        if _mesh(user, other) == mesh
    }
    attribute = mesh.attributes.get(name)
    if attribute is not None and name not in shown:
        mesh.attributes.remove(attribute)
    mesh.update_tag()


def free_name(thing: bpy.types.Object, mesh: bpy.types.Mesh, stem: str = KEPT_NAME) -> str:
    """The next "<stem> <n>" that nothing of an object, or of the mesh with the attributes, has."""
    keys = thing.data.shape_keys
    taken = {
        *thing.modifiers.keys(),
        *mesh.attributes.keys(),
        *thing.vertex_groups.keys(),
        *(keys.key_blocks.keys() if keys else ()),
    }
    number = 1
    while f"{stem} {number}" in taken:
        number += 1
    return f"{stem} {number}"


def keep(thing: bpy.types.Object, layer: bpy.types.NodesModifier) -> str:
    """Rename a layer to the next free "Press <n>" and make it the active modifier; its name."""
    rename(thing, layer, free_name(thing, _mesh(thing, layer)))
    thing.modifiers.active = layer
    _mesh(thing, layer).update_tag()
    name: str = layer.name
    return name


def write(
    thing: bpy.types.Object, layer: bpy.types.NodesModifier, vectors: NDArray[np.float32]
) -> None:
    """Write a layer's displacement, flat (3 p,), and have it drawn."""
    attribute = _attribute(thing, layer)
    if attribute is not None and 3 * len(attribute.data) == len(vectors):
        attribute.data.foreach_set("vector", vectors)
        _mesh(thing, layer).update_tag()


def displacement(
    thing: bpy.types.Object, layer: bpy.types.NodesModifier
) -> NDArray[np.float32] | None:
    """A layer's displacement at full strength, (p, 3); None where its mesh has none."""
    attribute = _attribute(thing, layer)
    if attribute is None:
        return None
    flat = np.empty(3 * len(attribute.data), dtype=np.float32)
    attribute.data.foreach_get("vector", flat)
    return flat.reshape(-1, 3)


def attribute_name(layer: bpy.types.NodesModifier) -> str:
    """Name of a layer's attribute."""
    name = modifier_inputs.value(layer, DISPLACEMENT)
    return name if isinstance(name, str) else ""


def carrier_of(layer: bpy.types.NodesModifier) -> bpy.types.Object | None:
    """Object whose mesh has a layer's attribute; None for the object's own."""
    carrier = modifier_inputs.value(layer, CARRIER)
    return carrier if isinstance(carrier, bpy.types.Object) and carrier.type == "MESH" else None


def strength(layer: bpy.types.NodesModifier) -> float:
    """A layer's strength."""
    factor = modifier_inputs.value(layer, STRENGTH)
    return float(factor) if isinstance(factor, int | float) else 1.0


def strength_path(layer: bpy.types.NodesModifier) -> str:
    """Path from the object to a layer's strength, for keyframes and drivers."""
    return modifier_inputs.path(layer, STRENGTH)


def set_strength(thing: bpy.types.Object, layer: bpy.types.NodesModifier, factor: float) -> None:
    """Set a layer's strength, 1 as it was pressed."""
    modifier_inputs.set_value(layer, STRENGTH, float(factor))
    thing.update_tag()


def _place(thing: bpy.types.Object, new: bpy.types.NodesModifier) -> int:
    """Place of a new modifier of Palpate's: behind those that come first, and what plays places."""
    place = 0
    for modifier in thing.modifiers:
        if modifier == new or (kind(modifier) is None and modifier.type not in PLAYERS):
            break
        place += 1
    return place


def _mesh(thing: bpy.types.Object, layer: bpy.types.NodesModifier) -> bpy.types.Mesh:
    carrier = carrier_of(layer)
    return thing.data if carrier is None else carrier.data


def _attribute(
    thing: bpy.types.Object, layer: bpy.types.NodesModifier
) -> bpy.types.Attribute | None:
    found = _mesh(thing, layer).attributes.get(attribute_name(layer))
    # A stranger's file may hold anything under this name.
    if found is None or (found.data_type, found.domain) != ("FLOAT_VECTOR", "POINT"):
        return None
    return found
