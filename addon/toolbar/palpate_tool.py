"""Tool Palpate: strokes on soft objects, with the circle of its radius on the surface."""

from pathlib import Path

import bpy

from ...operators.layer import layers
from ...operators.object import soft_object
from ..panels.base import draw_material
from . import surface_circle

IDNAME = "palpate.tool"
# Blender adds the suffix ".dat".
ICON = Path(__file__).with_name("palpate_icon")


def _key(
    kind: str, operator: str, *, shift: bool = False, value: str = "PRESS", **properties: object
) -> tuple[object, ...]:
    event = {"type": kind, "value": value, **({"shift": True} if shift else {})}
    return (operator, event, {"properties": list(properties.items())})


class PalpateTool(bpy.types.WorkSpaceTool):
    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_idname = IDNAME
    bl_label = "Palpate"
    bl_description = (
        "Push, pull, grab, twist or pinch soft objects: hold and drag, in any direction. Shift "
        "goes the other way"
    )
    bl_icon = str(ICON)
    bl_cursor = "CROSSHAIR"
    bl_operator = "palpate.stroke"
    bl_keymap = (
        _key("LEFTMOUSE", "palpate.stroke"),
        _key("LEFTMOUSE", "palpate.stroke", shift=True, outward=True),
        # A drag that meets nothing soft: Object Mode would move what is selected by it.
        _key("LEFTMOUSE", "view3d.select_box", value="CLICK_DRAG", mode="SET"),
        _key("LEFTMOUSE", "view3d.select_box", shift=True, value="CLICK_DRAG", mode="ADD"),
        _key("F", "palpate.stroke_size", what="RADIUS"),
        _key("F", "palpate.stroke_size", shift=True, what="STRENGTH"),
        ("palpate.hover", {"type": "MOUSEMOVE", "value": "ANY", "any": True}, None),
    )

    @staticmethod
    def draw_settings(
        context: bpy.types.Context, layout: bpy.types.UILayout, tool: bpy.types.WorkSpaceTool
    ) -> None:
        """Draw the settings in the header of the tool, or in its panel."""
        chosen, thing = context.scene.palpate, context.object
        if thing is not None and not soft_object.refusal(thing) and not thing.palpate.body_key:
            draw_material(layout, context)
            layout.operator("palpate.make_soft", icon="MOD_SOFT")
            return
        layout.prop(chosen, "stroke", text="")
        layout.prop(chosen, "tip_radius" if chosen.own_sizes else "tip_share", text="Radius")
        layout.prop(chosen, "stroke_strength")
        if chosen.stroke != "GRAB":
            layout.prop(chosen, "stroke_outward", toggle=True)
        row = layout.row(align=True)
        # As in Sculpt Mode, and no words: the header must fit a view of 1280 pixels.
        row.label(icon="MOD_MIRROR")
        row.prop(chosen, "stroke_mirrored", text="", toggle=True)
        if thing is not None and thing.type == "MESH":
            layout.prop(thing.palpate, "material", text="")
            if layers.layers_of(thing):
                layout.operator("palpate.animate_layers", icon="KEY_HLT")
            layout.operator("palpate.press", icon="FORCE_FORCE")

    @staticmethod
    def draw_cursor(
        context: bpy.types.Context, tool: bpy.types.WorkSpaceTool, xy: tuple[int, int]
    ) -> None:
        """Draw the tool's radius on the surface under the pointer."""
        surface_circle.draw(xy)


def register() -> None:
    """Put the tool into the toolbar, below the group that Measure ends."""
    # Behind most other tools Blender (to 5.2 at least) counts the end of the group wrongly, and
    # would split Move from Rotate.
    bpy.utils.register_tool(PalpateTool, after={"builtin.measure"}, separator=True)


def unregister() -> None:
    """Take it out again."""
    bpy.utils.unregister_tool(PalpateTool)
