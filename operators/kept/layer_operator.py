"""Base of operators that turn layers into something else."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ..layer import layers, live_layer
from ..reporting.acting import Acting
from ..scene import curves
from ..scene.drawn_surface import rest_coordinates

FINER = "The dents were finer than the mesh is; undo, and Object > Convert > Mesh keeps them so"
# Of a dent's depth that the mesh's own vertices must have, so that it counts as theirs.
SHOWN = 0.5


class OnLayers(Acting):
    """Mixin for an operator on an object with kept layers that is not pressed now."""

    @classmethod
    def layers_for(cls, thing: bpy.types.Object) -> list[bpy.types.NodesModifier]:
        """Layers that the operator can do something with."""
        return layers.kept_of(thing)

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        thing = context.object
        if thing is None or thing.type != "MESH" or not cls.layers_for(thing):
            return "Select a mesh object with layers; keep a press to make one"
        if not thing.is_editable or not thing.data.is_editable:
            return Sentence(
                "{name} is linked from another file; make it local (Object > Relations)",
                name=thing.name,
            )
        if thing.mode != "OBJECT":
            return "Go to Object Mode first"
        return live_layer.refusal(thing)


class IntoTheMesh(OnLayers):
    """Mixin for one that puts dents into the object's mesh."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        return super().refusal(context) or shared_refusal(context.object)


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
    is_finer: bool
    """Whether what is seen of it has vertices between those."""


def plain_layers(thing: bpy.types.Object) -> list[PlainLayer]:
    """Kept layers of an object, each of its own mesh and at a fixed strength.

    Raises
    ------
    PalpateError
        A layer is of other vertices or lost between those of the mesh, has lost its attribute,
        or its strength is animated.
    """
    found = []
    for layer in layers.kept_of(thing):
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
        own, is_finer = displacement, layers.carrier_of(layer) is not None
        if is_finer:
            own = displacement[: len(thing.data.vertices)]
            _refuse_lost(thing, layer, displacement, own)
        found.append(PlainLayer(layer, own.ravel(), layers.strength(layer), is_finer))
    return found


def _refuse_lost(
    thing: bpy.types.Object,
    layer: bpy.types.NodesModifier,
    seen: NDArray[np.float32],
    own: NDArray[np.float32],
) -> None:
    """Refuse a layer of a carrier, (m, 3), that the mesh's own vertices, (p, 3), cannot show."""
    # Faces that are divided keep the numbers of their corners.
    fine, rest = rest_coordinates(layers.mesh_of(thing, layer)), rest_coordinates(thing.data)
    is_divided = len(fine) >= len(rest) and np.allclose(
        fine[: len(rest)], rest, rtol=0.0, atol=1e-6
    )
    if not is_divided or np.abs(own).max() < SHOWN * np.abs(seen).max():
        raise PalpateError(
            "{name}: '{layer}' needs other vertices than the mesh's own; Object > Convert > Mesh "
            "makes what is seen the mesh",
            name=thing.name,
            layer=layer.name,
        )
