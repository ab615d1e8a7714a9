"""Force of the device: on or off, why, and the button to release it."""

import bpy

from ...operators.device.servo_words import FORCEFUL, Signal, Standing, standing
from ...operators.session.press_session import PressSession
from ...operators.session.press_state import Phase
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


def draw(layout: bpy.types.UILayout, context: bpy.types.Context, press: PressSession) -> None:
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
