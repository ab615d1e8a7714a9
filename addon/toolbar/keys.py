"""Shortcut of the tool, and Palpate in the Object menus."""

import bpy

from ...operators.reporting.translated import shown
from .palpate_tool import IDNAME

KEYMAP = "Object Mode"

_keys: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


class PALPATE_MT_object(bpy.types.Menu):
    bl_idname = "PALPATE_MT_object"
    bl_label = "Palpate"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_menu_enum("palpate.make_soft", "material")
        layout.operator("palpate.show_problems")
        layout.operator("palpate.remove_softness")
        layout.separator()
        tool = layout.operator("wm.tool_set_by_id", text=shown("Strokes"), translate=False)
        tool.name = IDNAME
        layout.operator("palpate.press")
        layout.operator("palpate.pinch")
        layout.separator()
        layout.operator("palpate.animate_layers")
        layout.operator("palpate.press_frames")
        layout.operator("palpate.animate_recording")
        layout.operator("palpate.add_press_rig")
        layout.operator("palpate.convert_layers")
        layout.operator("palpate.apply_layers")


def _in_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    if context.object is not None and context.object.type == "MESH":
        menu.layout.separator()
        menu.layout.menu(PALPATE_MT_object.bl_idname)


MENUS = ("VIEW3D_MT_object", "VIEW3D_MT_object_context_menu")
classes = (PALPATE_MT_object,)


def register() -> None:
    """Add menu entries, and the shortcut, which the preferences show under Object Mode."""
    for name in MENUS:
        getattr(bpy.types, name).append(_in_menu)
    configuration = bpy.context.window_manager.keyconfigs.addon
    if configuration is None:
        # Background mode has no keys.
        return
    keys = configuration.keymaps.new(KEYMAP)
    item = keys.keymap_items.new("wm.tool_set_by_id", "P", "PRESS", ctrl=True, alt=True)
    item.properties.name = IDNAME
    _keys.append((keys, item))


def unregister() -> None:
    """Remove them."""
    for keys, item in _keys:
        keys.keymap_items.remove(item)
    _keys.clear()
    for name in MENUS:
        getattr(bpy.types, name).remove(_in_menu)
