"""Softness in makers' words: Shore value, durometer, force curve and map."""

import bpy

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ...core.softness.ramp import legend
from ...core.softness.scales.shore import young_range
from ...operators.softness.softness_colours import ATTRIBUTE
from ..properties.softness import LEGEND_STEPS, shore_now
from .base import PalpatePanel, draw_rows, named_properties
from .sentence import say


class PALPATE_PT_softness(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_softness"
    bl_label = "Softness"
    bl_parent_id = "PALPATE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        layout.prop(context.object.palpate_softness, "place")
        _draw_reading(layout, context)
        layout.prop(context.object.palpate_softness, "finger_radius")
        _draw_curve(layout, context)
        _draw_map(layout, context)


def _draw_reading(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    softness = context.object.palpate_softness
    layout.prop(softness, "shore_scale")
    _draw_measuring(layout, "palpate.read_durometer", "DRIVER_DISTANCE")
    if not softness.read_scale:
        return
    rows = [
        ("Reading", f"Shore {softness.read_scale}  {softness.read_value:.0f}"),
        ("On a Thick Block", f"{softness.read_block:.0f}"),
    ]
    draw_rows(layout.column(align=True), rows)
    for warning in filter(None, softness.read_warnings.split("\n")):
        say(layout, context, Sentence.of_line(warning), "ERROR")


def _draw_curve(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    softness = context.object.palpate_softness
    _draw_measuring(layout, "palpate.force_curve", "FCURVE")
    if not softness.curve_text:
        return
    rows = [
        ("Stiffness", f"{softness.curve_stiffness:.3g} N/mm"),
        ("Force", f"{softness.curve_force:.3g} N"),
        ("Depth", f"{softness.curve_depth:.3g} mm"),
        ("Text Block", softness.curve_text),
    ]
    draw_rows(layout.column(align=True), rows)


def _draw_measuring(layout: bpy.types.UILayout, operator: str, icon: str) -> None:
    """Draw the button, and next to it one to click the place."""
    row = layout.row(align=True)
    row.operator(operator, icon=icon)
    row.operator(operator, icon="EYEDROPPER", text="").pick = True


def _draw_map(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the buttons, and the legend while the mesh has the colours."""
    thing = context.object
    softness = thing.palpate_softness
    row = layout.row(align=True)
    row.operator("palpate.map_softness", icon="COLOR")
    row.operator("palpate.remove_softness_map", icon="X", text="")
    if ATTRIBUTE not in thing.data.color_attributes or softness.map_low <= 0.0:
        return
    shading = context.space_data.shading
    if (shading.type, shading.color_type) != ("SOLID", "VERTEX"):
        say(layout, context, "Viewport Shading, Solid, Color, Attribute shows it", "INFO")
        layout.prop_enum(shading, "color_type", "VERTEX", text="Show It")
    column = layout.column(align=True)
    column.use_property_split = False
    values = [value for value, _ in legend(softness.map_low, softness.map_high, LEGEND_STEPS)]
    for step, value in reversed(list(enumerate(values))):
        split = column.split(factor=0.15, align=True)
        split.prop(softness, f"colours_{step}", text="")
        split.label(text=f"{value:.3g} N/mm", translate=False)


def draw_shore(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the Shore value and its scale, or that the material is beyond the scale."""
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


classes = (PALPATE_PT_softness,)
