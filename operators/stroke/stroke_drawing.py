"""Drawing of a stroke: what it does to the surface, and where an object that nobody holds goes."""

from __future__ import annotations

import bpy

from ..layer import live_layer
from ..lying import rest_layer
from ..lying.laid import move
from ..traction import layer_traction
from ..traction.drawn_traction import patches_of, tractions_of
from .answer.free_stroke import FreeStroke
from .answer.stroke import Stroke
from .answer.stroked import Stroked


def draw(thing: bpy.types.Object, stroke: Stroke | FreeStroke, stroked: Stroked) -> None:
    """Write the displacement of a stroke into the live layer, beside what shows how it rests."""
    drawn, lying = stroke.drawn, stroked.lying
    if lying is None:
        moved = drawn.drawn_displacement(stroked.displacements, stroked.tools, drawn.canvas)
        live_layer.write(thing, moved)
    else:
        moved = lying.moved
        live_layer.write(thing, moved - rest_layer.shown(thing, len(moved) // 3))
        move(thing, lying.frame)
    stroke.follow(stroked)
    layer_traction.write(thing, tractions_of(thing, drawn, moved, patches_of(stroked.touches)))
