"""One object that operators act on for a while."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy


@contextmanager
def chosen_alone(thing: bpy.types.Object) -> Iterator[None]:
    """Have an object be the active and the only selected one; afterwards those are that were.

    This is not an override of the context: up to Blender 5.0 an operator reads one without
    Python's lock while another thread holds that, and crashes.

    Raises
    ------
    RuntimeError
        The view layer does not have the object.
    """
    layer = bpy.context.view_layer
    active, selected = layer.objects.active, list(layer.objects.selected)
    layer.objects.active = thing
    try:
        _select(layer, [thing])
        yield
    finally:
        layer.objects.active = active
        _select(layer, selected)


def _select(layer: bpy.types.ViewLayer, things: list[bpy.types.Object]) -> None:
    for one in list(layer.objects.selected):
        one.select_set(False, view_layer=layer)
    for one in things:
        one.select_set(True, view_layer=layer)
