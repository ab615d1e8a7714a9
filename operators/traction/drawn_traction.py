"""Traction of the drawn vertices: what presses them, for shaders and geometry nodes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.contact.touches import ToolTouch, Touch
from ...core.contact.traction import PressedPatch, tractions
from ...core.servo.session import Snapshot
from ..object.drawn_body import DrawnBody


def patches_of(touches: Iterable[Touch]) -> Iterator[PressedPatch]:
    """Patches of all tools; a point has no area, and so no pressure."""
    return (PressedPatch.of_touch(one) for one in touches if isinstance(one, ToolTouch))


def patches_in(snapshot: Snapshot | None, tool: Tool | None) -> Iterator[PressedPatch]:
    """Patches of the servo's fingers, with their tool; none for points."""
    for finger in () if snapshot is None else snapshot.fingers:
        if tool is not None and finger.touching and len(finger.points):
            yield PressedPatch.of_finger(
                tool,
                Pose(np.asarray(finger.probe), np.asarray(finger.orientation)),
                np.asarray(finger.points),
                np.asarray(finger.point_forces),
                np.asarray(finger.pressures),
            )


def tractions_of(
    thing: bpy.types.Object,
    drawn: DrawnBody,
    moved: NDArray[np.float32],
    patches: Iterable[PressedPatch],
) -> NDArray[np.float32] | None:
    """Flat tractions (3 p,) of the drawn vertices once they are ``moved`` (3 p,), local units:
    contact pressure, pascal, times the outward normal of what is pressed, the object's axes at
    rest. None where the object tells of no forces.
    """
    if not thing.palpate.force_attributes:
        return None
    found = np.zeros_like(drawn.rest)
    pressed = [patch for patch in patches if len(patch.places)]
    if not pressed:
        return found
    metric = drawn.frame.metric
    near = np.flatnonzero(moved.reshape(-1, 3).any(axis=1))
    places = drawn.places[near] + moved.reshape(-1, 3)[near] @ metric
    of_body = tractions(pressed, places)
    sizes = np.linalg.norm(of_body, axis=1)
    # Normals go the other way than places: by the inverse transpose.
    turned = of_body @ metric
    lengths = np.linalg.norm(turned, axis=1)
    touched = lengths > 0.0
    rows = found.reshape(-1, 3)
    rows[near[touched]] = turned[touched] * (sizes[touched] / lengths[touched])[:, None]
    return found
