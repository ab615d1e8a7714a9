"""Layer by which an object shows how it sags where it rests; the mesh stays as it is."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..layer import layers

NAME = "Rests"


def show(thing: bpy.types.Object, vectors: NDArray[np.float32]) -> None:
    """Show a displacement (3 p,) of the drawn vertices at rest, local units."""
    layer = _find(thing)
    if layer is None or layers.strength(layer) != 1.0:
        remove(thing)
        layer = layers.add(thing, NAME)
    layers.write(thing, layer, vectors)


def is_shown(thing: bpy.types.Object) -> bool:
    """Whether an object has the layer."""
    return _find(thing) is not None


def shown(thing: bpy.types.Object, count: int) -> NDArray[np.float32]:
    """What is shown of the ``count`` drawn vertices, flat (3 p,), local units; zero without."""
    layer = _find(thing)
    vectors = None if layer is None or not layer.show_viewport else _vectors(thing, layer)
    if vectors is None or vectors.size != 3 * count:
        return np.zeros(3 * count, dtype=np.float32)
    return vectors


def remove(thing: bpy.types.Object) -> None:
    """Remove the layer. Safe without one."""
    layer = _find(thing)
    if layer is not None:
        layers.remove(thing, layer)


def _vectors(thing: bpy.types.Object, layer: bpy.types.NodesModifier) -> NDArray[np.float32] | None:
    vectors = layers.displacement(thing, layer)
    return None if vectors is None else vectors.ravel() * np.float32(layers.strength(layer))


def _find(thing: bpy.types.Object) -> bpy.types.NodesModifier | None:
    layer = thing.modifiers.get(NAME)
    return layer if layer is not None and layers.is_layer(layer) else None
