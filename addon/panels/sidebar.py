"""Sidebar tab: what to do next, the material, and what stays where it is.

Three panels are open at first: this one's first, Finger and Pins. What a newcomer has no name for
is where a device is chosen, and under Advanced.
"""

import bpy

from ...operators.bake import bake_session
from ...operators.session import press_session
from . import advanced, device, finger, recording, softness, state
from .base import PalpatePanel, named_properties, while_idle
from .kept import animation, layers
from .sentence import say


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
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        settings = context.object.palpate
        column = layout.column(align=True)
        column.prop(settings, "young_modulus", text="Stiffness (Pa)")
        softness.draw_shore(column, context)
        while_idle(column).prop(settings, "poisson_ratio")
        column.prop(settings, "relaxation")


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


class PALPATE_PT_imprint(PalpatePanel, bpy.types.Panel):
    bl_label = "Imprint"
    bl_parent_id = "PALPATE_PT_material"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        settings = context.object.palpate
        layout.prop(settings, "yield_depth")
        column = layout.column()
        column.active = settings.yield_depth > 0.0
        column.prop(settings, "forget_time")
        if settings.yield_depth > 0.0 and settings.pressers is not None:
            say(layout, context, "Of Pressers it is made by Bake Animation", "INFO")


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
        elif settings.pin_mode == "BELOW":
            layout.prop(settings, "pin_fraction")
            layout.operator("palpate.pin_below", icon="GROUP_VERTEX")
        elif settings.pin_mode == "NONE":
            layout.prop(settings, "steady")
        if settings.pin_mode != "NONE":
            layout.prop(context.scene.palpate, "show_pins")


class PALPATE_PT_rest(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_rest"
    bl_label = "Rests On"
    bl_parent_id = "PALPATE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.object.palpate.pin_mode == "NONE"

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = named_properties(self), context.object.palpate
        column = while_idle(layout)
        column.prop(settings, "floor")
        if settings.floor == "HEIGHT":
            column.prop(settings, "floor_height")
        column.prop(settings, "colliders")
        column.prop(settings, "rest_friction")
        column.prop(settings, "density", text="Density (kg/m³)")
        row = column.row(align=True)
        row.operator("palpate.settle", icon="TRIA_DOWN_BAR")
        row.operator("palpate.reset_rest", icon="LOOP_BACK")


classes = (
    PALPATE_PT_main,
    finger.PALPATE_PT_finger,
    PALPATE_PT_pins,
    PALPATE_PT_rest,
    PALPATE_PT_material,
    PALPATE_PT_touch,
    PALPATE_PT_imprint,
    PALPATE_PT_stiff_region,
    layers.PALPATE_PT_layers,
    animation.PALPATE_PT_animation,
    *softness.classes,
    *device.classes,
    *recording.classes,
    *advanced.classes,
)
