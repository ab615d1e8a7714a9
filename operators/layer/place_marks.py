"""Marks by which a place of the mesh as seen is found again at rest, while it is pressed.

A modifier before the live layer gives every vertex its place at rest, with its imprints, and its
place there; whatever comes later passes both on, to the vertices that it makes too.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from . import layers, stack
from .imprints import imprinted_rest
from .layer_groups import AT, DISPLACEMENT, LIVE, PRESSED, REST, Kind

NAME = "Palpate Places"


def needed(thing: bpy.types.Object) -> bool:
    """Whether anything but layers moves vertices, or makes some, after those that layers move; or
    these are not there yet.
    """
    keys = thing.data.shape_keys
    keyed = keys is not None and len(keys.key_blocks) > 1
    return keyed or layers.lacks_fine(thing) or bool(stack.following(thing, layers.made_by(thing)))


def hung(thing: bpy.types.Object) -> bool:
    """Whether the vertices are marked."""
    modifier = thing.modifiers.get(NAME)
    return modifier is not None and layers.kind(modifier) is Kind.PLACES


def hang(thing: bpy.types.Object, live: str) -> None:
    """Mark the vertices, where that is needed; ``live`` names the layer that follows a press."""
    remove(thing)
    if not needed(thing):
        return
    mesh = layers.drawn_mesh(thing)
    attribute = mesh.attributes.new(REST, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", imprinted_rest(thing))
    layers.add_modifier(thing, NAME, Kind.PLACES, {DISPLACEMENT: attribute.name, LIVE: live})


def remove(thing: bpy.types.Object) -> None:
    """Remove the marks. Safe without them."""
    if hung(thing):
        layers.remove_modifier(thing, thing.modifiers[NAME])
    mesh = layers.drawn_mesh(thing)
    for name in (REST, AT, PRESSED):
        attribute = mesh.attributes.get(name)
        if attribute is not None:
            mesh.attributes.remove(attribute)


@contextmanager
def marked(thing: bpy.types.Object, live: str = "") -> Iterator[None]:
    """Evaluation with marks, for as long as it lasts."""
    hang(thing, live)
    try:
        bpy.context.view_layer.update()
        yield
    finally:
        remove(thing)
