"""The sidebar tab: what is chosen, what is baked, what is missing and what to do about it."""

import textwrap

import bpy

from ..operators import bake_session, press_session, soft_object
from ..operators.bake_session import BakeSession
from ..operators.drawn_body import restores_quickly
from ..operators.press_session import PressSession
from ..operators.press_state import Phase
from ..operators.soft_object import BodyStatus, Fit
from . import known_status
from .reading import reading

# Width of a letter in the sidebar, unscaled pixels.
LETTER_PIXELS = 7


def _say(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str) -> None:
    """A sentence on as many lines as the sidebar's width needs."""
    scale = context.preferences.system.ui_scale
    letters = max(20, int(context.region.width / scale / LETTER_PIXELS) - 5)
    column = layout.column(align=True)
    column.use_property_split = False
    said = bpy.app.translations.pgettext_iface(text)
    for number, line in enumerate(textwrap.wrap(said, letters)):
        column.label(text=line, icon=icon if number == 0 else "BLANK1", translate=False)


class PalpatePanel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Palpate"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.type == "MESH"


class PALPATE_PT_main(bpy.types.Panel):
    bl_idname = "PALPATE_PT_main"
    bl_label = "Palpate"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Palpate"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        bake, press = bake_session.current(), press_session.current()
        if bake is not None:
            _draw_bake(layout, context, bake)
        elif press is not None:
            _draw_press(layout, context, press)
        else:
            _draw_idle(layout, context)


def _draw_bake(layout: bpy.types.UILayout, context: bpy.types.Context, bake: BakeSession) -> None:
    progress = bake.progress
    layout.label(text=bake.handle.name, icon="MOD_SOFT", translate=False)
    # A share that nobody can know yet is shown as time only.
    share = "" if progress.share is None else f"{100 * progress.share:.0f} %, "
    text = f"{share}{progress.seconds:.0f} s"
    layout.progress(factor=progress.share or 0.0, type="BAR", text=text, translate=False)
    _say(layout, context, progress.text, "TIME")
    layout.operator("palpate.cancel_bake", icon="CANCEL")


def _draw_press(
    layout: bpy.types.UILayout, context: bpy.types.Context, press: PressSession
) -> None:
    layout.label(text=press.handle.name, icon="MOD_SOFT", translate=False)
    if press.state.message:
        _say(layout, context, press.state.message, "ERROR")
    figures = reading(press)
    row = layout.row()
    row.label(text=f"{figures.force:.3f} N", icon="FORCE_FORCE", translate=False)
    row.label(text=f"{1000 * figures.depth:.1f} mm", icon="DRIVER_DISTANCE", translate=False)
    if press.state.phase is not Phase.LOST:
        _say(layout, context, "Enter keeps the shape, Escape restores it", "INFO")


def _draw_idle(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    thing = context.object
    refusal = soft_object.refusal(thing)
    column = layout.column(align=True)
    column.scale_y = 1.5
    if refusal:
        _say(layout, context, refusal, "INFO")
        return
    status = known_status.body_status(thing, context.scene)
    if status.fit is Fit.NEVER_BAKED:
        column.operator("palpate.make_soft", icon="MOD_SOFT")
        _say(layout, context, "Choose a material and pins, then press Make Soft", "INFO")
        return
    row = column.row()
    row.enabled = status.fit is Fit.READY or _press_restores(thing, status)
    row.operator("palpate.press", icon="FORCE_FORCE")
    column = layout.column(align=True)
    if status.fit in {Fit.FILE_MISSING, Fit.FILE_DAMAGED} or status.notes:
        column.operator("palpate.rebuild_body", icon="FILE_REFRESH")
    column.operator("palpate.make_soft", icon="MOD_SOFT", text="Make Soft Again")
    _draw_status(layout, context, status)


def _press_restores(thing: bpy.types.Object, status: BodyStatus) -> bool:
    """Whether Press itself computes the missing body again."""
    return status.fit is Fit.FILE_MISSING and restores_quickly(thing)


def _draw_status(
    layout: bpy.types.UILayout, context: bpy.types.Context, status: BodyStatus
) -> None:
    if status.fit is Fit.READY:
        _say(layout, context, "Ready to press", "CHECKMARK")
    elif _press_restores(context.object, status):
        _say(layout, context, "The body file is missing; Press computes it again", "INFO")
    elif status.fit is Fit.FILE_MISSING:
        _say(layout, context, "The body file is missing; press Rebuild Body", "ERROR")
    elif status.fit is Fit.FILE_DAMAGED:
        _say(layout, context, "The body file is damaged; press Rebuild Body", "ERROR")
    else:
        # As it begins a line, so that it is found in the dictionary.
        _say(layout, context, status.text[:1].upper() + status.text[1:], "ERROR")
        _say(layout, context, "Press Make Soft Again", "BLANK1")
    for note in status.notes:
        _say(layout, context, note, "INFO")
    if status.notes:
        _say(layout, context, "Rebuild Body takes them over", "BLANK1")


class PALPATE_PT_material(PalpatePanel, bpy.types.Panel):
    bl_label = "Material"
    bl_parent_id = "PALPATE_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.object.palpate
        layout.prop(settings, "material")
        column = layout.column(align=True)
        column.prop(settings, "young_modulus", text="Young's (Pa)")
        row = column.row()
        row.enabled = press_session.current() is None
        row.prop(settings, "poisson_ratio")


class PALPATE_PT_pins(PalpatePanel, bpy.types.Panel):
    bl_label = "Pins"
    bl_parent_id = "PALPATE_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.enabled = press_session.current() is None
        thing = context.object
        settings = thing.palpate
        layout.prop(settings, "pin_mode")
        if settings.pin_mode == "GROUP":
            layout.prop_search(settings, "pin_group", thing, "vertex_groups")
            if settings.pin_group not in thing.vertex_groups:
                _say(layout, context, "There is no such vertex group", "ERROR")
        else:
            layout.prop(settings, "pin_fraction")
            layout.operator("palpate.pin_below", icon="GROUP_VERTEX")


class PALPATE_PT_bake(PalpatePanel, bpy.types.Panel):
    bl_label = "Bake"
    bl_parent_id = "PALPATE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        thing = context.object
        settings = thing.palpate
        column = layout.column()
        column.enabled = bake_session.current() is None
        for name in ("edge_length", "epsilon", "decimate_above", "time_limit"):
            column.prop(settings, name)
        if any(modifier.type == "MIRROR" for modifier in thing.modifiers):
            text = "Only the base mesh is baked: apply the Mirror modifier first"
            _say(layout, context, text, "INFO")
        if settings.body_key:
            _draw_figures(layout, context, settings)
            layout.operator("palpate.remove_softness", icon="TRASH")


def _draw_figures(
    layout: bpy.types.UILayout, context: bpy.types.Context, settings: bpy.types.PropertyGroup
) -> None:
    figures = (
        ("Nodes", f"{settings.node_count:,}"),
        ("Tetrahedra", f"{settings.tet_count:,}"),
        ("Free Surface Nodes", f"{settings.free_surface_count:,}"),
        ("Memory", f"{settings.compliance_megabytes:.1f} MB"),
        ("Bake Time", f"{settings.bake_seconds:.1f} s"),
    )
    box = layout.box().column(align=True)
    for name, value in figures:
        row = box.split(factor=0.6)
        row.label(text=name)
        row.label(text=value, translate=False)
    for warning in filter(None, settings.bake_warnings.split("\n")):
        _say(layout, context, warning[:1].upper() + warning[1:], "ERROR")


class PALPATE_PT_press(PalpatePanel, bpy.types.Panel):
    bl_label = "Device"
    bl_parent_id = "PALPATE_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        chosen = context.scene.palpate
        idle = press_session.current() is None
        row = layout.row()
        row.enabled = idle
        row.prop(chosen, "source")
        if chosen.source == "SERIAL":
            row = layout.row(align=True)
            row.enabled = idle
            row.prop(chosen, "port")
            row.operator("palpate.refresh_devices", text="", icon="FILE_REFRESH")
        if chosen.source != "POINTER":
            layout.prop(chosen, "device_frame")
            layout.prop(chosen, "device_scale")


classes = (
    PALPATE_PT_main,
    PALPATE_PT_material,
    PALPATE_PT_pins,
    PALPATE_PT_press,
    PALPATE_PT_bake,
)
