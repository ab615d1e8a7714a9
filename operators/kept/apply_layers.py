"""Apply Layers to Mesh: the vertices move to where the shown layers put them."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ..layer import layers
from ..reporting.translated import reported
from .layer_operator import FINER, IntoTheMesh, plain_layers


class PALPATE_OT_apply_layers(IntoTheMesh, bpy.types.Operator):
    bl_idname = "palpate.apply_layers"
    bl_label = "Apply Layers to Mesh"
    bl_description = (
        "Move the vertices to where the shown layers put them, and remove these layers. The mesh "
        "is another one then; Make Soft bakes it again"
    )
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: bpy.types.Context) -> None:
        thing = context.object
        shown = [layer for layer in plain_layers(thing) if layer.modifier.show_viewport]
        moved = np.zeros(3 * len(thing.data.vertices), dtype=np.float32)
        for layer in shown:
            moved += np.float32(layer.strength) * layer.displacement
        _move(thing.data, moved)
        for layer in shown:
            layers.remove(thing, layer.modifier)
        thing.data.update()
        count = len(shown)
        self.report({"INFO"}, reported("{count} layers are in the mesh now", count=count))
        if any(layer.is_finer for layer in shown):
            self.report({"WARNING"}, reported(FINER))


def _move(mesh: bpy.types.Mesh, moved: NDArray[np.float32]) -> None:
    """Move all vertices, with all of their shapes, by flat displacements (3 p,)."""
    places = np.empty_like(moved)
    positions = mesh.attributes["position"].data
    positions.foreach_get("vector", places)
    positions.foreach_set("vector", places + moved)
    for key in mesh.shape_keys.key_blocks if mesh.shape_keys else ():
        key.points.foreach_get("co", places)
        key.points.foreach_set("co", places + moved)


classes = (PALPATE_OT_apply_layers,)
