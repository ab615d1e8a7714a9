"""Fingers: point or tool, contact mode, and a second finger."""

import bpy

from ...operators.session import press_session
from .base import PalpatePanel, named_properties, while_idle
from .sentence import say

MODE_TEXTS = {
    "CONSISTENT": "The touched point moves exactly as far as the finger",
    "PAPER": "As in the paper: inside triangles the surface stays a little short",
}
TIP_TEXTS = {
    "POINT": "A point's force depends on how finely the body is meshed",
    "MESH": "Its convex hull presses; the object itself is not changed",
}


class PALPATE_PT_finger(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_finger"
    bl_label = "Finger"
    bl_parent_id = "PALPATE_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        layout, chosen = named_properties(self), context.scene.palpate
        column = while_idle(layout)
        column.prop(chosen, "tip")
        _draw_sizes(column, context, chosen)
        if chosen.tip in TIP_TEXTS:
            say(column, context, TIP_TEXTS[chosen.tip], "INFO")
        if chosen.tip == "POINT":
            layout.prop(chosen, "contact_mode")
            say(layout, context, MODE_TEXTS[chosen.contact_mode], "BLANK1")
        else:
            layout.prop(chosen, "show_pressure")
            while_idle(layout).operator("palpate.press_frames", icon="RENDER_ANIMATION")


def _draw_sizes(
    layout: bpy.types.UILayout, context: bpy.types.Context, chosen: bpy.types.PropertyGroup
) -> None:
    column = layout.column(align=True)
    match chosen.tip:
        case "SPHERE":
            column.prop(chosen, "tip_radius")
        case "PLATE":
            column.prop(chosen, "plate_width")
            column.prop(chosen, "plate_depth")
        case "ROD":
            column.prop(chosen, "tip_radius")
            column.prop(chosen, "rod_length")
        case "MESH":
            column.prop(chosen, "tip_object")
            if chosen.tip_object is None:
                say(layout, context, "Choose a mesh object of the scene as the tool", "ERROR")
    if chosen.tip not in {"POINT", "SPHERE"}:
        layout.prop(chosen, "tip_turn")
        if chosen.tip_turn == "OBJECT":
            layout.prop(chosen, "turn_object")


class PALPATE_PT_second_finger(PalpatePanel, bpy.types.Panel):
    bl_label = "Second Finger"
    bl_parent_id = "PALPATE_PT_press"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, chosen = named_properties(self), context.scene.palpate
        layout.enabled = press_session.current() is None
        layout.prop(chosen, "second")
        if chosen.second == "EMPTY":
            layout.prop(chosen, "second_empty")
        elif chosen.second != "NONE":
            if chosen.second in {"SERIAL", "HAPLY"}:
                layout.prop(chosen, "second_port")
            if chosen.second == "HAPLY":
                layout.prop(chosen, "second_haply_model")
                layout.prop(chosen, "second_haply_at_rest")
            layout.prop(chosen, "second_frame")
        say(layout, context, "Pinch leads two fingers with the pointer", "INFO")
