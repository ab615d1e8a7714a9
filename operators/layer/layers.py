"""Layers of an object: each a modifier and the displacement of the vertices that it adds.

The displacement is a point attribute, local units, at rest: of the object's mesh, or of its carrier
where modifiers make other vertices. The mesh itself stays as it is, and layers add up in any order.
"""

from __future__ import annotations

from collections.abc import Mapping

import bpy
import numpy as np
from numpy.typing import NDArray

from ..scene import curves
from . import layer_groups, modifier_inputs, remains, stack
from .layer_groups import CARRIER, DISPLACEMENT, LEVEL, STRENGTH, TRACTION, Kind, group_of, kind_of

KEPT_NAME = "Press"
# Layers that are written anew: by a press that goes on, and by Pressers as they move.
LIVE_NAME, PRESSERS_NAME = "Palpate Live", "Palpate Pressers"
FINE_NAME = "Palpate Fine"
# Custom property of a carrier: how often the faces are halved for its vertices.
HALVED, MOST_HALVED = "palpate_halved", 7
# And how many of them modifiers of the object made, before they were halved.
SEEN = "palpate_seen"


def carrier(thing: bpy.types.Object) -> bpy.types.Object | None:
    """The hidden object whose vertices are those that an object's layers move; None where they are
    the object's own.
    """
    found = thing.palpate.carrier
    # A stranger's file may name any object.
    return found if found is not None and found.type == "MESH" and found != thing else None


def drawn_mesh(thing: bpy.types.Object) -> bpy.types.Mesh:
    """Mesh with the vertices that layers move, at rest: the object's, or its carrier's."""
    found = carrier(thing)
    return thing.data if found is None else found.data


def made_by(thing: bpy.types.Object) -> list[bpy.types.Modifier]:
    """Modifiers that make the drawn mesh; none where that is the object's own, or only finer."""
    on = carrier(thing)
    return stack.making(thing) if seen_count(on) else []


def seen_count(on: bpy.types.Object | None) -> int:
    """Vertices that an object's modifiers made for its carrier; 0 where they made none."""
    count = 0 if on is None else on.get(SEEN, 0)
    return count if isinstance(count, int) else 0


def layers_of(thing: bpy.types.Object) -> list[bpy.types.NodesModifier]:
    """Modifiers of an object that are layers, in their order."""
    return [modifier for modifier in thing.modifiers if is_layer(modifier)]


def kept_of(thing: bpy.types.Object) -> list[bpy.types.NodesModifier]:
    """Layers of an object that stay as they are until somebody changes them."""
    return [one for one in layers_of(thing) if one.name not in {LIVE_NAME, PRESSERS_NAME}]


def is_layer(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier is a layer."""
    return kind(modifier) in {Kind.LAYER, Kind.FORCES}


def kind_for(thing: bpy.types.Object) -> Kind:
    """The kind of an object's layers: whether they tell of forces."""
    return Kind.FORCES if thing.palpate.force_attributes else Kind.LAYER


def kind(modifier: bpy.types.Modifier) -> Kind | None:
    """What a modifier of Palpate's adds; None for all others."""
    return kind_of(modifier.node_group) if modifier.type == "NODES" else None


def add(thing: bpy.types.Object, name: str) -> bpy.types.NodesModifier:
    """Add a layer that displaces nothing yet.

    Blender gives another name where this one is taken.
    """
    mesh = drawn_mesh(thing)
    remains.sweep(mesh)
    attribute = mesh.attributes.new(name, "FLOAT_VECTOR", "POINT")
    if name != LIVE_NAME:
        remains.note(mesh, attribute.name)
    return add_modifier(thing, name, kind_for(thing), {DISPLACEMENT: attribute.name})


def add_modifier(
    thing: bpy.types.Object, name: str, added: Kind, inputs: Mapping[str, object]
) -> bpy.types.NodesModifier:
    """Add a modifier of Palpate's on the drawn mesh with values of its other inputs: behind all
    that makes this mesh, before all that poses it.
    """
    on = carrier(thing)
    if on is not None:
        refine(thing, halved(on))
    modifier = _new(thing, name, added, {**inputs, CARRIER: on})
    thing.modifiers.move(len(thing.modifiers) - 1, _place(thing, modifier))
    return modifier


def _new(
    thing: bpy.types.Object, name: str, added: Kind, inputs: Mapping[str, object]
) -> bpy.types.NodesModifier:
    modifier = thing.modifiers.new(name, "NODES")
    modifier.node_group = group_of(added)
    for given, value in inputs.items():
        modifier_inputs.set_value(modifier, given, value)
    modifier.show_expanded = False
    return modifier


def halved(on: bpy.types.Object) -> int:
    """How often faces are halved for the vertices of a carrier."""
    level = on.get(HALVED, 0)
    return min(level, MOST_HALVED) if isinstance(level, int) and level > 0 else 0


def refine(thing: bpy.types.Object, level: int) -> None:
    """Have an object's faces halved so often, before all layers; nothing for 0."""
    found = _fine(thing)
    if not level:
        return
    if found is None:
        found = _new(thing, FINE_NAME, Kind.FINE, {})
        thing.modifiers.move(len(thing.modifiers) - 1, _first_place(thing))
    modifier_inputs.set_value(found, LEVEL, level)


def lacks_fine(thing: bpy.types.Object) -> bool:
    """Whether the faces of an object are not divided yet as its carrier has them."""
    on = carrier(thing)
    return on is not None and halved(on) > 0 and _fine(thing) is None


def _fine(thing: bpy.types.Object) -> bpy.types.NodesModifier | None:
    return next((one for one in thing.modifiers if kind(one) is Kind.FINE), None)


def remove_modifier(thing: bpy.types.Object, modifier: bpy.types.NodesModifier) -> None:
    """Remove a modifier of Palpate's; the division of faces with the last that needs it."""
    thing.modifiers.remove(modifier)
    fine = _fine(thing)
    if fine is not None and not any(map(_is_on_vertices, thing.modifiers)):
        thing.modifiers.remove(fine)


def _is_on_vertices(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier has something for each drawn vertex."""
    return modifier.type in stack.PLAYERS or kind(modifier) not in {None, Kind.FINE}


def rename(thing: bpy.types.Object, layer: bpy.types.NodesModifier, name: str) -> None:
    """Rename a layer and its attributes."""
    attribute = _attribute(thing, layer)
    if attribute is not None:
        traction = mesh_of(thing, layer).attributes.get(attribute.name + TRACTION)
        attribute.name = name
        modifier_inputs.set_value(layer, DISPLACEMENT, attribute.name)
        remains.note(mesh_of(thing, layer), attribute.name)
        if traction is not None:
            traction.name = attribute_name(layer) + TRACTION
    layer.name = name


def remove(thing: bpy.types.Object, layer: bpy.types.NodesModifier) -> None:
    """Remove a layer or a rig, its animation, and its attributes where nothing else shows them."""
    mesh = mesh_of(thing, layer)
    remains.note(mesh, attribute_name(layer))
    # What takes its name later would move by them.
    for slider in layer_groups.AXES if kind(layer) is Kind.RIG else (STRENGTH,):
        curves.remove(thing, modifier_inputs.path(layer, slider))
    remove_modifier(thing, layer)
    remains.sweep(mesh)
    mesh.update_tag()


def free_name(thing: bpy.types.Object, mesh: bpy.types.Mesh, stem: str = KEPT_NAME) -> str:
    """The next "<stem> <n>" that nothing of an object, or of the mesh with the attributes, has; nor
    with more words behind it, as attributes of layers and rigs have them.
    """
    keys = thing.data.shape_keys
    taken = {
        *thing.modifiers.keys(),
        *mesh.attributes.keys(),
        *thing.vertex_groups.keys(),
        *(keys.key_blocks.keys() if keys else ()),
    }
    number = 1
    while any(f"{one} ".startswith(f"{stem} {number} ") for one in taken):
        number += 1
    return f"{stem} {number}"


def keep(thing: bpy.types.Object, layer: bpy.types.NodesModifier) -> str:
    """Rename a layer to the next free "Press <n>" and make it the active modifier; its name."""
    rename(thing, layer, free_name(thing, mesh_of(thing, layer)))
    thing.modifiers.active = layer
    mesh_of(thing, layer).update_tag()
    name: str = layer.name
    return name


def write(
    thing: bpy.types.Object, layer: bpy.types.NodesModifier, vectors: NDArray[np.float32]
) -> None:
    """Write a layer's displacement, flat (3 p,), and have it drawn."""
    attribute = _attribute(thing, layer)
    if attribute is not None and 3 * len(attribute.data) == len(vectors):
        attribute.data.foreach_set("vector", vectors)
        mesh_of(thing, layer).update_tag()


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


def _first_place(thing: bpy.types.Object) -> int:
    """Place behind the modifiers that make the drawn mesh."""
    found = made_by(thing)
    return thing.modifiers.find(found[-1].name) + 1 if found else 0


def place_of_vertices(thing: bpy.types.Object) -> int:
    """Place right behind what makes the drawn vertices, which is added where it is missing."""
    on = carrier(thing)
    refine(thing, 0 if on is None else halved(on))
    return _first_place(thing) + (_fine(thing) is not None)


def _place(thing: bpy.types.Object, new: bpy.types.NodesModifier) -> int:
    """Place of a new modifier: behind those of Palpate's, and what plays places."""
    place = _first_place(thing)
    for modifier in thing.modifiers[place:]:
        if modifier == new or (kind(modifier) is None and modifier.type not in stack.PLAYERS):
            break
        place += 1
    return place


def mesh_of(thing: bpy.types.Object, layer: bpy.types.NodesModifier) -> bpy.types.Mesh:
    """Mesh with a layer's attributes."""
    carrier = carrier_of(layer)
    return thing.data if carrier is None else carrier.data


def _attribute(
    thing: bpy.types.Object, layer: bpy.types.NodesModifier
) -> bpy.types.Attribute | None:
    found = mesh_of(thing, layer).attributes.get(attribute_name(layer))
    # A stranger's file may hold anything under this name.
    if found is None or (found.data_type, found.domain) != ("FLOAT_VECTOR", "POINT"):
        return None
    return found
