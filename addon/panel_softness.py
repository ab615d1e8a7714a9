"""Softness in the maker's words: the Shore value beside Young's modulus."""

import bpy

from ..core.errors import PalpateError
from ..core.softness.shore import young_range
from .sentence import say
from .softness_properties import shore_now


def draw_shore(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The Shore value and its scale, or that the scale does not reach the material."""
    thing = context.object
    softness = thing.palpate_softness
    row = layout.row(align=True)
    row.prop(softness, "shore")
    row.prop(softness, "shore_scale", text="")
    try:
        shore_now(thing)
    except PalpateError:
        material = thing.palpate
        softest, _ = young_range(softness.shore_scale, material.poisson_ratio)
        softer = material.young_modulus < softest
        text = "Softer than this scale tells" if softer else "Firmer than this scale tells"
        say(layout, context, text, "INFO")
