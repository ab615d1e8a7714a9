"""Layers that are let go: where the object yields, what is beyond its yield depth stays."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..layer import layers, live_layer
from ..scene.body_frame import BodyFrame
from ..traction import layer_traction
from .surface_imprint import yielding_of


class NothingStaysError(PalpateError):
    """Press that was nowhere beyond the yield depth."""


def keep(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    frame: BodyFrame,
    left: NDArray[np.float32] | None = None,
) -> str:
    """Keep the live layer, of an object that yields as it is once it is let go; returns its name.

    Parameters
    ----------
    left : flat (3 p,), local units, what stays; without it, what is left of the layer by itself.

    Raises
    ------
    NothingStaysError
        Nothing is; the layer is still live.
    """
    law = yielding_of(thing, frame)
    if not law.elastic:
        if left is None:
            metres = _displacement(thing) @ frame.metric
            stays = frame.local_from_body(law.grown(np.zeros_like(metres), metres))
            left = stays.astype(np.float32).ravel()
        if not left.any():
            raise NothingStaysError(
                "{name} springs back: nothing was pressed farther than its yield depth; press "
                "deeper, or lower Yield Depth",
                name=thing.name,
            )
        live_layer.write(thing, left)
        # Nothing presses it any more.
        layer_traction.write(thing, None)
    name = live_layer.keep(thing)
    if law.forget and not law.elastic:
        _fade(thing, thing.modifiers[name], scene, law.forget)
    return name


def keep_moved(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    frame: BodyFrame,
    moved: NDArray[np.float32],
    tractions: NDArray[np.float32] | None = None,
) -> str:
    """Keep flat displacements (3 p,), local units, of a press that has ended, and what it bore;
    returns the layer's name.

    Raises
    ------
    NothingStaysError
        The object springs back, and is as it was.
    """
    live_layer.hang(thing)
    try:
        live_layer.write(thing, moved)
        layer_traction.write(thing, tractions)
        return keep(thing, scene, frame)
    except BaseException:
        live_layer.remove(thing)
        raise


def _displacement(thing: bpy.types.Object) -> NDArray[np.float64]:
    """Displacements (p, 3) of the live layer, local units."""
    live = live_layer.find(thing)
    found = None if live is None else layers.displacement(thing, live)
    if found is None:
        raise RuntimeError(f"{thing.name} has no live layer to keep")
    return found.astype(np.float64)


def _fade(
    thing: bpy.types.Object, layer: bpy.types.NodesModifier, scene: bpy.types.Scene, seconds: float
) -> None:
    """Let a layer fade from the present frame on: by a driver that also works without Palpate."""
    frames = seconds * scene.render.fps / scene.render.fps_base
    curve = thing.driver_add(layers.strength_path(layer))
    # Blender evaluates such an expression itself, also where scripts are not allowed.
    curve.driver.expression = f"exp(-max(frame - {scene.frame_current}, 0) / {frames:.9g})"
