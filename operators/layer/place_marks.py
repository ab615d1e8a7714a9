"""Marks by which a place of the mesh as seen is found again at rest, while it is pressed.

A modifier before the live layer gives every vertex its place at rest and its place there; whatever
comes later passes both on, to the vertices that it makes too.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..scene.drawn_surface import rest_coordinates
from . import layers
from .layer_groups import AT, CARRIER, DISPLACEMENT, REST, Kind

NAME = "Palpate Places"


def needed(thing: bpy.types.Object) -> bool:
    """Whether modifiers other than layers move or make vertices."""
    return any(
        modifier.show_viewport and layers.kind(modifier) is None for modifier in thing.modifiers
    )


def hang(thing: bpy.types.Object) -> None:
    """Mark the vertices, where that is needed."""
    remove(thing)
    if not needed(thing):
        return
    mesh = thing.data
    attribute = mesh.attributes.new(REST, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", rest_coordinates(mesh))
    layers.add_modifier(thing, NAME, Kind.PLACES, {DISPLACEMENT: attribute.name, CARRIER: None})


def remove(thing: bpy.types.Object) -> None:
    """Remove the marks. Safe without them."""
    modifier = thing.modifiers.get(NAME)
    if modifier is not None and layers.kind(modifier) is Kind.PLACES:
        thing.modifiers.remove(modifier)
    for name in (REST, AT):
        attribute = thing.data.attributes.get(name)
        if attribute is not None:
            thing.data.attributes.remove(attribute)


@contextmanager
def marked(thing: bpy.types.Object) -> Iterator[None]:
    """Evaluation with marks, for as long as it lasts."""
    hang(thing)
    try:
        bpy.context.view_layer.update()
        yield
    finally:
        remove(thing)
