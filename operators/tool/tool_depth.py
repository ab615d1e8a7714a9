"""Depth of a tool in a body: how far it is beyond where it would touch the rest surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ..scene import ray

Array = NDArray[np.float64]

# Share of a tool's reach within which places of it are equally deep.
FLAT = 1e-3


def depth_of(
    tool: Tool,
    pose: Pose,
    inward: Array,
    nodes: Array,
    triangles: NDArray[np.int64],
    farthest: float = np.inf,
) -> float:
    """How far a tool has gone along ``inward`` (3,), unit, from where it would touch the rest
    surface, metres: from its deepest place back to the first surface that faces it, however far
    beyond a thin part that has given way. 0 where there is none, and where that is more than the
    tool's size beyond ``farthest``, metres: then it is another part.
    """
    core = tool.core @ pose.rotation.T
    heights = core @ inward
    # A face that lies across is deepest in its middle.
    deepest = core[heights > heights.max() - FLAT * tool.reach].mean(axis=0)
    tip = pose.position + deepest + tool.radius * inward
    # From behind, seen from within, so with the triangles turned round.
    hit = ray.first_hit(tip, -inward, nodes, triangles[:, ::-1])
    return 0.0 if hit is None or hit.distance > farthest + tool.size else hit.distance
