"""Kept presses: their strengths, and what they can be turned into."""

import bpy

from ....operators.layer import layers, modifier_inputs
from ....operators.layer.layer_groups import STRENGTH
from ..base import PalpatePanel, while_idle


class PALPATE_PT_layers(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_layers"
    bl_label = "Layers"
    bl_parent_id = "PALPATE_PT_main"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and bool(layers.layers_of(context.object))

    def draw(self, context: bpy.types.Context) -> None:
        thing = context.object
        column = self.layout.column(align=True)
        for layer in layers.layers_of(thing):
            row = column.row(align=True)
            row.prop(layer, "show_viewport", text="")
            modifier_inputs.draw_slider(row, layer, STRENGTH, layer.name)
        column = while_idle(self.layout).column(align=True)
        column.operator("palpate.convert_layers", icon="SHAPEKEY_DATA")
        column.operator("palpate.apply_layers", icon="CHECKMARK")


classes = (PALPATE_PT_layers,)
