"""Remove Dent: a kept press or a rig goes, and all that it left in the mesh; or Pressers press
no more.
"""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ..layer import layers, press_rig
from .layer_operator import OnLayers


class PALPATE_OT_remove_layer(OnLayers, bpy.types.Operator):
    bl_idname = "palpate.remove_layer"
    bl_label = "Remove Dent"
    bl_description = (
        "Take a kept press or a press rig back, with its keyframes and its attributes of the mesh; "
        "or have the Pressers press no more"
    )
    bl_options = {"REGISTER", "UNDO"}

    layer: bpy.props.StringProperty(
        name="Layer", description="Name of its modifier", options={"SKIP_SAVE", "HIDDEN"}
    )

    @classmethod
    def layers_for(cls, thing: bpy.types.Object) -> list[bpy.types.NodesModifier]:
        return [*layers.layers_of(thing), *press_rig.rigs_of(thing)]

    def act(self, context: bpy.types.Context) -> None:
        thing = context.object
        found = next((one for one in self.layers_for(thing) if one.name == self.layer), None)
        if found is None:
            raise PalpateError(
                "{name}: it has no layer '{layer}'; choose one of those under Layers",
                name=thing.name,
                layer=self.layer,
            )
        if found.name == layers.PRESSERS_NAME:
            # They would press it again at the next move. Its update takes the layer away.
            thing.palpate.pressers = None
            return
        layers.remove(thing, found)


classes = (PALPATE_OT_remove_layer,)
