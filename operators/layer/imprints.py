"""Imprints that an object has: of what yields, the kept layers are its surface by now.

Nothing strains it there. So a press meets the surface at rest with its imprints on it, while a
layer of an elastic object is a shape that something holds, and presses add up to it.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..scene.drawn_surface import rest_coordinates
from . import layers

# Decimals of a strength: less of a change is not felt.
FELT = 2


def imprint_of(thing: bpy.types.Object) -> NDArray[np.float32]:
    """Displacements (p, 3) of the drawn vertices by the imprints that are shown, local units; none
    where the object springs back, or nothing holds it.
    """
    moved = np.zeros((len(layers.drawn_mesh(thing).vertices), 3), dtype=np.float32)
    for layer in _imprints(thing):
        vectors = layers.displacement(thing, layer)
        if vectors is not None:
            moved += np.float32(layers.strength(layer)) * vectors
    return moved


def told_by(thing: bpy.types.Object) -> tuple[object, ...]:
    """What tells one imprint of an object from another, as far as it may be felt."""
    return tuple(
        (layers.attribute_name(one), round(layers.strength(one), FELT)) for one in _imprints(thing)
    )


def imprinted_rest(thing: bpy.types.Object) -> NDArray[np.float32]:
    """The drawn vertices where a press finds them before it begins, flat (3 p,), local units: at
    rest, with the imprints.
    """
    return rest_coordinates(layers.drawn_mesh(thing)) + imprint_of(thing).ravel()


def _imprints(thing: bpy.types.Object) -> list[bpy.types.NodesModifier]:
    chosen, mesh = thing.palpate, layers.drawn_mesh(thing)
    is_loose = chosen.pin_mode == "NONE" and not chosen.steady
    if chosen.yield_depth == 0.0 or is_loose:
        return []
    return [
        one
        for one in layers.kept_of(thing)
        if one.show_viewport and layers.mesh_of(thing, one) == mesh
    ]
