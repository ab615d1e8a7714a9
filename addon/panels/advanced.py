"""Advanced: bake and method, the body that was made, the shape drawn, the paper's point."""

import bpy

from ...operators.bake import bake_session
from ...operators.layer import stack
from ...operators.object import soft_object
from ...operators.session import press_session
from ..properties.soft_object import FORMULATION_ITEMS
from . import cost, shape
from .base import PalpatePanel, named_properties, while_idle
from .sentence import say

MODE_TEXTS = {
    "CONSISTENT": "The touched point moves exactly as far as the finger",
    "PAPER": "As in the paper: inside triangles the surface stays a little short",
}


class PALPATE_PT_advanced(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_advanced"
    bl_label = "Advanced"
    bl_parent_id = "PALPATE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, chosen = named_properties(self), context.scene.palpate
        column = while_idle(layout)
        column.prop_enum(chosen, "tip", "POINT", text="Press with a Point")
        if chosen.tip == "POINT":
            text = "A point's force depends on how finely the body is meshed"
            say(column, context, text, "INFO")
            layout.prop(chosen, "contact_mode")
            say(layout, context, MODE_TEXTS[chosen.contact_mode], "BLANK1")


class PALPATE_PT_bake(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_bake"
    bl_label = "Bake"
    bl_parent_id = "PALPATE_PT_advanced"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        thing = context.object
        idle = bake_session.current() is None and press_session.current() is None
        column = layout.column()
        column.enabled = idle
        for name in ("edge_length", "epsilon", "decimate_above", "time_limit"):
            column.prop(thing.palpate, name)
        if stack.making(thing):
            column.prop(thing.palpate, "bake_from")
        column.operator("palpate.show_problems", icon="VIEWZOOM")
        if idle and not soft_object.refusal(thing):
            cost.draw_prediction(layout, context)


class PALPATE_PT_method(PalpatePanel, bpy.types.Panel):
    bl_label = "Method"
    bl_parent_id = "PALPATE_PT_bake"

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        layout.enabled = bake_session.current() is None and press_session.current() is None
        thing = context.object
        settings = thing.palpate
        choices = layout.row(heading="Formulation", align=True)
        for item in FORMULATION_ITEMS:
            choices.prop_enum(settings, "formulation", item[0])
        layout.prop(settings, "form")
        row = layout.row()
        row.active = settings.form != "DENSE"
        row.prop(settings, "compression_tolerance")


class PALPATE_PT_body(PalpatePanel, bpy.types.Panel):
    bl_label = "Baked Body"
    bl_parent_id = "PALPATE_PT_bake"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and bool(context.object.palpate.body_key)

    def draw(self, context: bpy.types.Context) -> None:
        layout, chosen = named_properties(self), context.scene.palpate
        layout.prop(chosen, "show_tetrahedra")
        if chosen.show_tetrahedra:
            layout.prop(chosen, "cut_axis", expand=True)
            layout.prop(chosen, "cut", slider=True)
        cost.draw_figures(layout, context)
        self.layout.operator("palpate.remove_softness", icon="TRASH")


classes = (
    PALPATE_PT_advanced,
    shape.PALPATE_PT_shape,
    PALPATE_PT_bake,
    PALPATE_PT_method,
    PALPATE_PT_body,
)
