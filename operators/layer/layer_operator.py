"""Base of operators that turn layers into something else."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ..reporting.acting import Acting
from ..scene import curves
from . import layers, live_layer


class OnLayers(Acting):
    """Mixin for an operator on an object with kept layers that is not pressed now."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        thing = context.object
        if thing is None or thing.type != "MESH" or not layers.kept_of(thing):
            return "Select a mesh object with layers; keep a press to make one"
        if not thing.is_editable or not thing.data.is_editable:
            return Sentence(
                "{name} is linked from another file; make it local (Object > Relations)",
                name=thing.name,
            )
        if thing.mode != "OBJECT":
            return "Go to Object Mode first"
        if live_layer.find(thing) is not None:
            return "Finish pressing first: Enter keeps the shape, Escape restores it"
        return ""


def shared_refusal(thing: bpy.types.Object) -> str:
    """Reason why an object's dents cannot go into its mesh: others would have them; empty if none
    would.
    """
    if thing.data.users - thing.data.use_fake_user > 1:
        return "Other objects share its mesh; Object > Relations > Make Single User"
    return ""


@dataclass(frozen=True, eq=False)
class PlainLayer:
    """Layer with its flat displacement (3 p,) of the object's own vertices at full strength."""

    modifier: bpy.types.NodesModifier
    displacement: NDArray[np.float32]
    strength: float


def plain_layers(thing: bpy.types.Object) -> list[PlainLayer]:
    """Kept layers of an object, each of its own mesh and at a fixed strength.

    Raises
    ------
    PalpateError
        A layer is of another mesh, has lost its attribute, or its strength is animated.
    """
    found = []
    for layer in layers.kept_of(thing):
        if layers.carrier_of(layer) is not None:
            raise PalpateError(
                "{name}: '{layer}' is of the mesh that its modifiers make; Object > Convert > Mesh "
                "makes what is seen the mesh",
                name=thing.name,
                layer=layer.name,
            )
        displacement = layers.displacement(thing, layer)
        if displacement is None:
            raise PalpateError(
                "{name}: '{layer}' has lost its attribute; remove that modifier",
                name=thing.name,
                layer=layer.name,
            )
        if curves.is_animated(thing, layers.strength_path(layer)):
            raise PalpateError(
                "{name}: the strength of '{layer}' is animated; remove its keyframes or driver",
                name=thing.name,
                layer=layer.name,
            )
        found.append(PlainLayer(layer, displacement.ravel(), layers.strength(layer)))
    return found
