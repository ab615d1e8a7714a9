"""Kept presses: their strengths, and what they can be turned into."""

import bpy

from ....operators.layer import layers, modifier_inputs, press_rig
from ....operators.layer.layer_groups import AXES, STRENGTH
from ..base import PalpatePanel, while_idle


class PALPATE_PT_layers(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_layers"
    bl_label = "Layers"
    bl_parent_id = "PALPATE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and bool(
            layers.layers_of(context.object) or context.object.palpate.body_key
        )

    def draw(self, context: bpy.types.Context) -> None:
        thing = context.object
        column = self.layout.column(align=True)
        for layer in layers.layers_of(thing):
            if layer.name == layers.LIVE_NAME:
                # The press itself, which keeps it or takes it away.
                continue
            row = column.row(align=True)
            row.prop(layer, "show_viewport", text="")
            modifier_inputs.draw_slider(row, layer, STRENGTH, layer.name)
            row = while_idle(row)
            row.operator("palpate.remove_layer", text="", icon="X").layer = layer.name
        for rig in press_rig.rigs_of(thing):
            column = self.layout.column(align=True)
            row = column.row(align=True)
            row.label(text=rig.name, icon="EMPTY_AXIS", translate=False)
            row = while_idle(row)
            row.operator("palpate.remove_layer", text="", icon="X").layer = rig.name
            for axis in AXES:
                modifier_inputs.draw_slider(column, rig, axis, axis)
        column = while_idle(self.layout).column(align=True)
        column.operator("palpate.animate_layers", icon="KEY_HLT")
        column.prop(thing.palpate, "force_attributes")
        column.operator("palpate.add_press_rig", icon="EMPTY_AXIS")
        column.operator("palpate.convert_layers", icon="SHAPEKEY_DATA")
        column.operator("palpate.apply_layers", icon="CHECKMARK")


classes = (PALPATE_PT_layers,)
