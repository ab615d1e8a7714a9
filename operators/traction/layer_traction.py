"""Tractions of layers: an attribute beside that of the displacement, and groups that show both."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..layer import layers, live_layer, modifier_inputs
from ..layer.layer_groups import CARRIER, DISPLACEMENT, STRENGTH, TRACTION, group_of
from .point_attribute import point_attribute


def write(thing: bpy.types.Object, tractions: NDArray[np.float32] | None) -> None:
    """Write flat tractions (3 p,) of the live layer, pascal, object's axes; None for none."""
    live = live_layer.find(thing)
    if live is not None:
        write_of(thing, live, tractions)


def write_of(
    thing: bpy.types.Object, layer: bpy.types.NodesModifier, tractions: NDArray[np.float32] | None
) -> None:
    """The same of any layer."""
    mesh = layers.mesh_of(thing, layer)
    name = layers.attribute_name(layer) + TRACTION
    if tractions is None:
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
        return
    attribute = point_attribute(mesh, name, "FLOAT_VECTOR")
    if 3 * len(attribute.data) == len(tractions):
        attribute.data.foreach_set("vector", tractions)
        mesh.update_tag()


def follow(thing: bpy.types.Object) -> None:
    """Let all layers show forces, or not, as the object says now."""
    group = group_of(layers.kind_for(thing))
    for layer in layers.layers_of(thing):
        values = {
            name: modifier_inputs.value(layer, name) for name in (DISPLACEMENT, CARRIER, STRENGTH)
        }
        layer.node_group = group
        for name, value in values.items():
            modifier_inputs.set_value(layer, name, value)
    thing.update_tag()
