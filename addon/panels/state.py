"""Top of the sidebar tab: present activity, what is missing, and its remedy."""

import bpy

from ...core.quantities import duration
from ...operators.bake import bake_words
from ...operators.bake.bake_session import BakeSession
from ...operators.device.servo_words import FORCEFUL, Signal, Standing, standing
from ...operators.layer import layers, stack
from ...operators.object import soft_object
from ...operators.object.drawn_body import restores_quickly
from ...operators.object.pin_change import PinFit
from ...operators.object.soft_object import BodyStatus, Fit
from ...operators.reporting.quantities import newtons, scene_length
from ...operators.reporting.translated import shown
from ...operators.session.press_events import Source
from ...operators.session.press_session import PressSession
from ...operators.session.press_state import Phase
from .. import known_status
from ..overlay.reading import readings
from . import cost
from .base import draw_material
from .sentence import say

# Coloured squares: green, orange and red mean motors on, about to come, and something wrong.
ICONS = {
    Signal.OFF: "COLORSET_10_VEC",
    Signal.WAITING: "COLORSET_10_VEC",
    Signal.READY: "COLORSET_03_VEC",
    Signal.FORCE: "COLORSET_02_VEC",
    Signal.RETURNING: "COLORSET_09_VEC",
    Signal.FAULT: "COLORSET_01_VEC",
}
# Drawn vertices a free surface node of the body, below which dents look faceted.
COARSE = 0.25
# Reasons for the work that changed pins need.
PIN_TEXTS = {
    PinFit.KNOWN: "These pins were computed before: no bake needed",
    PinFit.MORE: "More is pinned: takes effect in about {time}, no bake needed",
    PinFit.LESS: "Less is pinned than before: needs a bake",
    PinFit.OTHER: "The pins changed and need a bake",
}


def draw_bake(layout: bpy.types.UILayout, context: bpy.types.Context, bake: BakeSession) -> None:
    """Draw a running bake."""
    progress = bake.progress
    layout.label(text=bake.handle.name, icon="MOD_SOFT", translate=False)
    # An unknown share is shown as time only.
    factor = progress.share or 0.0
    layout.progress(factor=factor, type="BAR", text=bake_words.how_far(progress), translate=False)
    say(layout, context, progress.text, "TIME")
    layout.operator("palpate.cancel_bake", icon="CANCEL")
    if bake.preview_off:
        layout.operator("palpate.press", icon="FORCE_FORCE")
        say(layout, context, bake_words.previewed(bake.preview_off), "INFO")


def draw_press(layout: bpy.types.UILayout, context: bpy.types.Context, press: PressSession) -> None:
    """Draw a running press."""
    layout.label(text=press.handle.name, icon="MOD_SOFT", translate=False)
    if press.state.source is Source.DEVICE:
        _draw_force(layout, context, press)
    elif press.state.message:
        say(layout, context, press.state.message, "ERROR")
    for figures in readings(press):
        row = layout.row()
        row.label(text=newtons(figures.force), icon="FORCE_FORCE", translate=False)
        depth = scene_length(context.scene, figures.depth)
        row.label(text=depth, icon="DRIVER_DISTANCE", translate=False)
    if press.state.phase is not Phase.LOST:
        say(layout, context, "Enter keeps the shape, Escape restores it", "INFO")


def _draw_force(
    layout: bpy.types.UILayout, context: bpy.types.Context, press: PressSession
) -> None:
    """Draw the force at the top of the panel while a device presses."""
    row = layout.row()
    row.scale_y = 2.0
    text, icon = ("Force Off", "COLORSET_01_VEC") if press.state.force_on else ("Force On", "PLAY")
    # In the light theme dark letters are unreadable on red.
    row.alert = press.state.force_on and _has_bright_letters(context)
    row.operator("palpate.switch_force", text=text, icon=icon)
    if press.snapshot is not None:
        _draw_standing(layout, context, standing(press.snapshot))
    if press.state.message and press.state.phase is not Phase.LOST:
        say(layout, context, press.state.message, "INFO")


def _draw_standing(layout: bpy.types.UILayout, context: bpy.types.Context, now: Standing) -> None:
    column = layout.column(align=True)
    column.alert = now.signal is Signal.FAULT
    column.label(text=now.word, icon=ICONS[now.signal])
    # Too frequent a change for the panel, which would jump; the view shows it.
    if now.why and now.signal not in FORCEFUL:
        say(column, context, now.why, "BLANK1")


def _has_bright_letters(context: bpy.types.Context) -> bool:
    red, green, blue = context.preferences.themes[0].user_interface.wcol_tool.text
    return bool(red + green + blue > 1.5)


def draw_idle(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the possible actions on the object."""
    thing = context.object
    refusal = soft_object.refusal(thing)
    if refusal:
        say(layout, context, refusal, "INFO")
        return
    draw_material(layout, context)
    column = layout.column(align=True)
    column.scale_y = 1.5
    status = known_status.body_status(thing, context.scene)
    if status is None:
        column.enabled = False
        column.operator("palpate.press", icon="FORCE_FORCE")
        say(layout, context, "Comparing the mesh with its body", "TIME")
        return
    if status.fit is Fit.NEVER_BAKED:
        column.operator("palpate.make_soft", icon="MOD_SOFT")
        if thing.palpate.bake_from != "BASE":
            _draw_source(layout, context)
        cost.draw_summary(layout, context)
        return
    row = column.row()
    row.enabled = status.fit is Fit.READY or _press_restores(thing, status)
    row.operator("palpate.press", icon="FORCE_FORCE")
    row.operator("palpate.pinch", icon="ARROW_LEFTRIGHT")
    column = layout.column(align=True)
    if _update_suffices(status):
        column.operator("palpate.update_pins", icon="PINNED")
    elif _rebuild_helps(status):
        column.operator("palpate.rebuild_body", icon="FILE_REFRESH")
    column.operator("palpate.make_soft", icon="MOD_SOFT", text="Make Soft Again")
    if status.fit is Fit.CHANGED:
        cost.draw_summary(layout, context)
    _draw_status(layout, context, status)


def _press_restores(thing: bpy.types.Object, status: BodyStatus) -> bool:
    """Whether Press recomputes the missing body itself."""
    return status.fit is Fit.FILE_MISSING and restores_quickly(thing)


def _pins_alone(status: BodyStatus) -> bool:
    """Whether only the pins differ from the body."""
    return status.fit is Fit.READY and not status.changed and status.pins.fit is not PinFit.SAME


def _update_suffices(status: BodyStatus) -> bool:
    """Whether Update Pins applies all changed settings."""
    return _pins_alone(status) and status.pins.quick


def _rebuild_helps(status: BodyStatus) -> bool:
    lost = status.fit in {Fit.FILE_MISSING, Fit.FILE_DAMAGED}
    other_pins = status.pins.fit not in {PinFit.SAME, PinFit.UNUSABLE}
    return lost or bool(status.changed) or other_pins


def _draw_status(
    layout: bpy.types.UILayout, context: bpy.types.Context, status: BodyStatus
) -> None:
    if context.object.palpate.preview_off:
        say(layout, context, "This is a coarse preview; press Make Soft Again", "INFO")
    elif status.fit is Fit.READY:
        say(layout, context, "Ready to press", "CHECKMARK")
    elif _press_restores(context.object, status):
        say(layout, context, "The body file is missing; Press computes it again", "INFO")
    elif status.fit is Fit.FILE_MISSING:
        say(layout, context, "The body file is missing; press Rebuild Body", "ERROR")
    elif status.fit is Fit.FILE_DAMAGED:
        say(layout, context, "The body file is damaged; press Rebuild Body", "ERROR")
    else:
        say(layout, context, status.text, "ERROR")
        say(layout, context, "Press Make Soft Again", "BLANK1")
    _draw_changes(layout, context, status)
    _draw_resolution(layout, context)


def _draw_source(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw which modifiers are filled with the mesh, if any."""
    made_by = ", ".join(modifier.name for modifier in stack.making(context.object))
    if made_by:
        say(layout, context, "As seen: with {modifiers}", "INFO", modifiers=made_by)


def _draw_resolution(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw where dents come on a finer mesh, and a hint where that is still coarse."""
    thing, mesh = context.object, layers.drawn_mesh(context.object)
    drawn, body = len(mesh.vertices), thing.palpate.free_surface_count
    if layers.made_by(thing):
        _draw_source(layout, context)
    if mesh != thing.data and layers.halved(thing.palpate.carrier):
        text = "Dents come on {count} finer vertices; the mesh keeps its own"
        say(layout, context, text, "INFO", count=f"{drawn:,}")
    if drawn < COARSE * body:
        text = "Only {count} vertices are drawn: a dent needs more; subdivide the mesh"
        say(layout, context, text, "INFO", count=f"{drawn:,}")


def _draw_changes(
    layout: bpy.types.UILayout, context: bpy.types.Context, status: BodyStatus
) -> None:
    """Draw settings that differ from the body, and the operator that applies them."""
    pins = status.pins
    if pins.fit is PinFit.UNUSABLE:
        say(layout, context, pins.reason, "ERROR")
    elif _pins_alone(status):
        say(layout, context, PIN_TEXTS[pins.fit], "INFO", time=duration(max(1.0, pins.seconds)))
        if _update_suffices(status):
            say(layout, context, "Press does it by itself, too", "BLANK1")
    names = list(status.changed)
    if pins.fit not in {PinFit.SAME, PinFit.UNUSABLE} and not _pins_alone(status):
        names.append("Pins")
    names += status.meshing
    if names:
        listed = ", ".join(map(shown, names))
        say(layout, context, "Changed since the bake: {names}", "INFO", names=listed)
    if status.meshing:
        say(layout, context, "Make Soft Again takes it over", "BLANK1")
    elif status.fit is Fit.READY and _rebuild_helps(status) and not _update_suffices(status):
        say(layout, context, "Rebuild Body takes it over", "BLANK1")
