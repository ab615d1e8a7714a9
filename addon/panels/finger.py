"""Finger: what presses, and how large it is."""

import bpy

from .base import PalpatePanel, named_properties, while_idle
from .sentence import say

# Two a row; the point, which feels the mesh, is under Advanced.
TIPS = (("SPHERE", "PLATE"), ("ROD", "MESH"))
LENGTHS = {
    "SPHERE": ("tip_radius",),
    "PLATE": ("plate_width", "plate_depth"),
    "ROD": ("tip_radius", "rod_length"),
}


class PALPATE_PT_finger(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_finger"
    bl_label = "Finger"
    bl_parent_id = "PALPATE_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        layout, chosen = named_properties(self), context.scene.palpate
        column = while_idle(layout)
        choices = column.column(align=True)
        choices.use_property_split = False
        for tips in TIPS:
            row = choices.row(align=True)
            for tip in tips:
                row.prop_enum(chosen, "tip", tip)
        if chosen.tip == "POINT":
            say(column, context, "A point presses; see Advanced", "INFO")
            return
        _draw_sizes(column, context, chosen)
        layout.prop(chosen, "show_pressure")


def _draw_sizes(
    layout: bpy.types.UILayout, context: bpy.types.Context, chosen: bpy.types.PropertyGroup
) -> None:
    column = layout.column(align=True)
    if chosen.tip == "MESH":
        column.prop(chosen, "tip_object")
        if chosen.tip_object is None:
            say(layout, context, "Choose a mesh object of the scene as the tool", "ERROR")
        text = "Its convex hull presses; the object itself is not changed"
        say(layout, context, text, "INFO")
    else:
        first, *more = LENGTHS[chosen.tip] if chosen.own_sizes else ("tip_share",)
        row = column.row(align=True)
        row.prop(chosen, first)
        row.prop(chosen, "own_sizes", text="", icon="DRIVER_DISTANCE")
        for name in more:
            column.prop(chosen, name)
    if chosen.tip != "SPHERE":
        layout.prop(chosen, "tip_turn")
        if chosen.tip_turn == "OBJECT":
            layout.prop(chosen, "turn_object")
