"""Convert Layers to Shape Keys: each layer a shape key of its name and strength."""

import bpy

from ..layer import layers
from ..reporting.translated import reported
from ..scene.drawn_surface import rest_coordinates
from .layer_operator import FINER, IntoTheMesh, plain_layers


class PALPATE_OT_convert_layers(IntoTheMesh, bpy.types.Operator):
    bl_idname = "palpate.convert_layers"
    bl_label = "Convert Layers to Shape Keys"
    bl_description = (
        "Turn every kept press into a shape key of its name and strength, for programs that know "
        "no modifiers"
    )
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: bpy.types.Context) -> None:
        thing = context.object
        found = plain_layers(thing)
        if thing.data.shape_keys is None:
            thing.shape_key_add(name="Basis", from_mix=False)
        rest = rest_coordinates(thing.data)
        for layer in found:
            modifier, strength = layer.modifier, layer.strength
            key = thing.shape_key_add(name=modifier.name, from_mix=False)
            key.relative_key = thing.data.shape_keys.reference_key
            key.points.foreach_set("co", rest + layer.displacement)
            key.slider_min, key.slider_max = min(0.0, strength), max(1.0, strength)
            key.value, key.mute = strength, not modifier.show_viewport
            layers.remove(thing, modifier)
        thing.data.update()
        count = len(found)
        self.report({"INFO"}, reported("{count} layers are shape keys now", count=count))
        if any(layer.is_finer for layer in found):
            self.report({"WARNING"}, reported(FINER))


classes = (PALPATE_OT_convert_layers,)
