"""One press without pointer, device or clock: for scripts, command line and background Blender."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import ArrayLike

from ..core.contact import Touch
from . import live_shape
from .drawn_body import open_body


@dataclass(frozen=True, eq=False)
class Pressed:
    """What one press did; vectors in world axes, SI units."""

    touch: Touch
    force: tuple[float, float, float]
    depth: float
    largest_displacement: float
    shape_key: str


def press_once(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    at: ArrayLike,
    by: ArrayLike,
    *,
    keep: bool = True,
) -> Pressed:
    """Press the surface point nearest to ``at`` by ``by`` (3,), world units; keep a shape key.

    Raises
    ------
    PalpateError
        The object cannot be pressed, or a coordinate is not finite.
    """
    drawn = open_body(thing, scene)
    frame, young_modulus = drawn.frame, thing.palpate.young_modulus
    inward = frame.turn_to_body(np.asarray(by, dtype=np.float64)) * frame.metres_per_unit
    touch = drawn.body.touch_nearest(frame.body_from_world(at), inward, young_modulus)
    displacements = drawn.body.deform(touch.triangle, touch.nodal_forces, young_modulus)
    name = ""
    if keep:
        live_shape.hang(thing)
        live_shape.write(thing.data, drawn.local_coordinates(displacements))
        name = live_shape.keep(thing)
        thing.data.update()
    x, y, z = frame.turn_to_world(touch.force).tolist()
    return Pressed(
        touch=touch,
        force=(x, y, z),
        depth=float(np.linalg.norm(inward)),
        largest_displacement=float(np.linalg.norm(displacements, axis=1).max()),
        shape_key=name,
    )
