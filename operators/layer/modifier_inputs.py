"""Inputs of a node modifier by name: their values, and their paths for animation and sliders.

Until Blender 5.1 they are custom properties of the modifier; since 5.2 properties of their own.
"""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from .layer_groups import socket


def value(modifier: bpy.types.NodesModifier, name: str) -> object:
    """Value of an input; None where it has none."""
    return _at(modifier, socket(modifier.node_group, name))


def all_values(modifier: bpy.types.NodesModifier) -> Iterator[tuple[str, str, object]]:
    """Identifiers of all inputs of a modifier, the paths to them from the object, and their values;
    None of one without.
    """
    group = modifier.node_group
    for item in group.interface.items_tree if group is not None else ():
        if item.item_type == "SOCKET" and item.in_out == "INPUT":
            key = item.identifier
            yield key, _path(modifier, key), _at(modifier, key)


def set_value(modifier: bpy.types.NodesModifier, name: str, given: object) -> None:
    """Set the value of an input."""
    key = socket(modifier.node_group, name)
    if _has_properties(modifier):
        getattr(modifier.properties.inputs, key).value = given
    else:
        modifier[key] = given


def path(modifier: bpy.types.NodesModifier, name: str) -> str:
    """Path from the object to an input, for keyframes and drivers."""
    return _path(modifier, socket(modifier.node_group, name))


def draw_slider(
    layout: bpy.types.UILayout, modifier: bpy.types.NodesModifier, name: str, text: str
) -> None:
    """Draw the slider of an input."""
    key = socket(modifier.node_group, name)
    if _has_properties(modifier):
        owner, of_owner = getattr(modifier.properties.inputs, key), "value"
    else:
        owner, of_owner = modifier, f'["{key}"]'
    layout.prop(owner, of_owner, text=text, translate=False)


def _at(modifier: bpy.types.NodesModifier, key: str) -> object:
    if _has_properties(modifier):
        # Geometry has none.
        return getattr(getattr(modifier.properties.inputs, key, None), "value", None)
    return modifier.get(key)


def _path(modifier: bpy.types.NodesModifier, key: str) -> str:
    inside = f".properties.inputs.{key}.value" if _has_properties(modifier) else f'["{key}"]'
    return f'modifiers["{bpy.utils.escape_identifier(modifier.name)}"]{inside}'


def _has_properties(modifier: bpy.types.NodesModifier) -> bool:
    return hasattr(modifier, "properties")
