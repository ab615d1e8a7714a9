"""Transform of an object whose body moves by itself: changed, remembered and brought back.

Where the object was is remembered from the first move on, until it is brought back; from where it
was moved by hand meanwhile, if it was.
"""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ..scene import curves
from ..scene.body_frame import BodyFrame

# By which matrices of an object at the same place may differ, as a share of their largest number.
SAME = 1e-5
# What places an object, besides its scale.
CHANNELS = ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle")
# Properties by which an object remembers where it was.
REMEMBERED = ("is_laid", "laid_from", "laid_to", "has_floor", "floor_found", "is_keyed")


def lay(thing: bpy.types.Object, frame: BodyFrame, floor: float | None) -> None:
    """Move an object to where a frame is; its scale stays. ``floor`` is the height of what it
    rests on, metres, None without one.
    """
    remember(thing, floor)
    move(thing, frame)


def move(thing: bpy.types.Object, frame: BodyFrame) -> None:
    """Move an object that was laid on to where a frame is: it is not moved by hand there."""
    place(thing, frame)
    thing.palpate.laid_to = np.array(thing.matrix_world).ravel()


def remember(thing: bpy.types.Object, floor: float | None) -> None:
    """Remember where an object is, unless it was laid there, and its floor's height, metres."""
    chosen, now = thing.palpate, np.array(thing.matrix_world).ravel()
    was_moved = not chosen.is_keyed and not same_place(now, np.array(chosen.laid_to))
    if not chosen.is_laid or was_moved:
        chosen.laid_from = now
    if not chosen.is_laid:
        chosen.has_floor, chosen.floor_found = floor is not None, floor or 0.0
    chosen.is_laid = True


def place(thing: bpy.types.Object, frame: BodyFrame) -> None:
    """Move an object to where a frame is, and remember nothing."""
    scale = thing.scale.copy()
    thing.matrix_world = Matrix(frame.matrix.tolist())
    # Taken apart and put together, a scale is not quite what it was.
    if np.allclose(thing.scale, scale, rtol=1e-4, atol=0.0):
        thing.scale = scale


def bring_back(thing: bpy.types.Object) -> None:
    """Bring an object back to where it was before it was first laid. Safe where it was not."""
    chosen = thing.palpate
    if chosen.is_laid:
        thing.matrix_world = Matrix(np.reshape(chosen.laid_from, (4, 4)).tolist())
    forget(thing)


def forget(thing: bpy.types.Object) -> None:
    """Forget where an object was."""
    for name in REMEMBERED:
        thing.palpate.property_unset(name)


def found_floor(thing: bpy.types.Object) -> float | None:
    """Height, metres, of the floor that was found under an object; None before."""
    chosen = thing.palpate
    return float(chosen.floor_found) if chosen.is_laid and chosen.has_floor else None


def same_place(one: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    """Whether two matrices are the same but for rounding."""
    return bool(np.abs(one - other).max() <= SAME * np.abs(one).max())


def is_animated(thing: bpy.types.Object) -> bool:
    """Whether keyframes or drivers place an object."""
    return any(curves.is_animated(thing, channel) for channel in CHANNELS)
