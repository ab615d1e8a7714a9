"""The object that operators act on: active, and the only one selected."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import bpy


def make_active(layer: bpy.types.ViewLayer, thing: bpy.types.Object) -> None:
    """Make an object the active one, and the only one selected.

    Raises
    ------
    RuntimeError
        The view layer does not have it; nothing is changed.
    """
    layer.objects.active = thing
    _select(layer, [thing])


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
    make_active(layer, thing)
    try:
        yield
    finally:
        layer.objects.active = active
        _select(layer, selected)


def _select(layer: bpy.types.ViewLayer, things: Iterable[bpy.types.Object]) -> None:
    for one in list(layer.objects.selected):
        one.select_set(False, view_layer=layer)
    for one in things:
        one.select_set(True, view_layer=layer)
