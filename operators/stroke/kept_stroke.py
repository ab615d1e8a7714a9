"""Where a stroke is drawn and kept on its object."""

from __future__ import annotations

import bpy

from ..object.drawn_body import DrawnBody
from ..scene import live_shape
from .stroke import Stroked


def begin(thing: bpy.types.Object) -> None:
    """Make a place for the stroke, on top of all that was kept before."""
    live_shape.hang(thing)


def draw(thing: bpy.types.Object, drawn: DrawnBody, stroked: Stroked) -> None:
    """Draw a stroke as it is now."""
    coordinates = drawn.local_coordinates(stroked.displacements, stroked.tools)
    live_shape.write(thing.data, coordinates)


def keep(thing: bpy.types.Object) -> str:
    """Keep the stroke; returns the name it has."""
    name = live_shape.keep(thing)
    thing.data.update()
    return name


def give_up(thing: bpy.types.Object) -> None:
    """Remove the stroke; the object is as before."""
    live_shape.remove(thing)
