"""Placement of a body in the world, metres, and the frame of its object."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...core.contact.tool.pose import Pose
from ..scene.body_frame import BodyFrame


def placement_of(frame: BodyFrame) -> Pose:
    """Where the body's axes are in the world, metres."""
    return Pose(frame.metres_per_unit * frame.origin, frame.rotation)


def apart(one: Pose, other: Pose, size: float) -> float:
    """How far two placements of a body are apart, as a share of its ``size``, metres; a turn counts
    as the way of what is so far off.
    """
    turned = np.abs(one.rotation - other.rotation).max()
    return float(max(turned, np.abs(one.position - other.position).max() / size))


def frame_at(frame: BodyFrame, placement: Pose) -> BodyFrame:
    """A frame, of an object that is stretched as one, where the body's axes are placed."""
    origin = placement.position / frame.metres_per_unit
    return replace(frame, rotation=placement.rotation, origin=origin)
