"""Sidebar tab: settings, body and predicted cost."""

import bpy

from ...operators.bake import bake_session
from ...operators.device.device_source import is_planar
from ...operators.object import soft_object
from ...operators.scene.package_preferences import preferences
from ...operators.session import press_session
from . import cost, finger, loop, recording, shape, softness, state
from .base import PalpatePanel, named_properties, while_idle
from .sentence import say

# Purpose of each formulation, in a line.
FORMULATION_TEXTS = {
    "linear": "Linear: as in the paper, right up to about 0.4",
    "smoothed": "Smoothed: does not lock near 0.5",
}


class PALPATE_PT_main(bpy.types.Panel):
    bl_idname = "PALPATE_PT_main"
    bl_label = "Palpate"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Palpate"

    def draw(self, context: bpy.types.Context) -> None:
        bake, press = bake_session.current(), press_session.current()
        if bake is not None:
            state.draw_bake(self.layout, context, bake)
        elif press is not None:
            state.draw_press(self.layout, context, press)
        else:
            state.draw_idle(self.layout, context)


class PALPATE_PT_material(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_material"
    bl_label = "Material"
    bl_parent_id = "PALPATE_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        settings = context.object.palpate
        layout.prop(settings, "material")
        column = layout.column(align=True)
        column.prop(settings, "young_modulus", text="Young's (Pa)")
        softness.draw_shore(column, context)
        while_idle(column).prop(settings, "poisson_ratio")


class PALPATE_PT_stiff_region(PalpatePanel, bpy.types.Panel):
    bl_label = "Stiff Region"
    bl_parent_id = "PALPATE_PT_material"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        layout.enabled = press_session.current() is None
        thing = context.object
        settings = thing.palpate
        layout.prop_search(settings, "stiff_group", thing, "vertex_groups")
        if not settings.stiff_group:
            text = "Bone in flesh: a closed shell inside the mesh, as a vertex group"
            say(layout, context, text, "INFO")
            return
        layout.prop(settings, "stiff_factor")
        if settings.stiff_group not in thing.vertex_groups:
            say(layout, context, "There is no such vertex group", "ERROR")


class PALPATE_PT_touch(PalpatePanel, bpy.types.Panel):
    bl_label = "Touch"
    bl_parent_id = "PALPATE_PT_material"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        settings = context.object.palpate
        layout.prop(settings, "shading")
        column = layout.column(align=True)
        column.prop(settings, "static_friction")
        column.prop(settings, "dynamic_friction", text="Sliding")


class PALPATE_PT_pins(PalpatePanel, bpy.types.Panel):
    bl_label = "Pins"
    bl_parent_id = "PALPATE_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        layout.enabled = press_session.current() is None
        thing = context.object
        settings = thing.palpate
        layout.prop(settings, "pin_mode")
        if settings.pin_mode == "GROUP":
            layout.prop_search(settings, "pin_group", thing, "vertex_groups")
            if settings.pin_group not in thing.vertex_groups:
                say(layout, context, "There is no such vertex group", "ERROR")
        else:
            layout.prop(settings, "pin_fraction")
            layout.operator("palpate.pin_below", icon="GROUP_VERTEX")


class PALPATE_PT_press(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_press"
    bl_label = "Device"
    bl_parent_id = "PALPATE_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        chosen = context.scene.palpate
        column = while_idle(layout)
        column.prop(chosen, "source")
        if chosen.source == "POINTER":
            return
        if chosen.source == "EMPTY":
            column.prop(chosen, "source_empty")
            return
        if chosen.source == "SIMULATED":
            column.prop(chosen, "simulated_kind")
        else:
            row = column.row(align=True)
            row.prop(chosen, "port")
            row.operator("palpate.refresh_devices", text="", icon="FILE_REFRESH")
        if chosen.source == "SERIAL":
            column.prop(chosen, "baud")
        if is_planar(context.scene):
            column.prop(chosen, "haply_model")
        if chosen.source == "HAPLY":
            column.prop(chosen, "haply_at_rest")
            if press_session.current() is None:
                text = "Before Press, put the handle in its rest pose and leave it there"
                say(layout, context, text, "INFO")
        layout.prop(chosen, "device_frame")
        layout.prop(chosen, "device_scale")
        layout.prop(preferences(), "stable_contact")
        layout.prop(chosen, "show_workspace")
        loop.draw_adapter_warning(layout, context)


class PALPATE_PT_bake(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_bake"
    bl_label = "Bake"
    bl_parent_id = "PALPATE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        thing = context.object
        idle = bake_session.current() is None and press_session.current() is None
        column = layout.column()
        column.enabled = idle
        for name in ("edge_length", "epsilon", "decimate_above", "time_limit"):
            column.prop(thing.palpate, name)
        if any(modifier.type == "MIRROR" for modifier in thing.modifiers):
            text = "Only the base mesh is baked: apply the Mirror modifier first"
            say(layout, context, text, "INFO")
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
        layout.prop(settings, "formulation")
        say(layout, context, FORMULATION_TEXTS[soft_object.formulation_now(thing)], "INFO")
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
        cost.draw_figures(self.layout, context)
        self.layout.operator("palpate.remove_softness", icon="TRASH")


classes = (
    PALPATE_PT_main,
    PALPATE_PT_material,
    PALPATE_PT_touch,
    PALPATE_PT_stiff_region,
    PALPATE_PT_pins,
    finger.PALPATE_PT_finger,
    shape.PALPATE_PT_shape,
    PALPATE_PT_press,
    finger.PALPATE_PT_second_finger,
    *loop.classes,
    *recording.classes,
    *softness.classes,
    PALPATE_PT_bake,
    PALPATE_PT_method,
    PALPATE_PT_body,
)
