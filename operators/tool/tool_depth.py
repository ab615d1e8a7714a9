"""Depth of a finger in a body: of a tool, how far it is beyond where it would touch the rest
surface; of a point, from the surface at rest to the finger.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.mesh.tet_mesh import TetMesh
from ...core.servo.session import FingerSnapshot
from ..place import ray

Array = NDArray[np.float64]

# Share of a tool's reach within which places of it are equally deep.
FLAT = 1e-3
# Nothing is further in than the surface went, times this: the near field takes it as far as the
# tool.
FARTHEST = 1.5


def finger_depth(
    mesh: TetMesh, tool: Tool | None, finger: FingerSnapshot, moved: Array | None
) -> float:
    """Depth of a finger of the servo, a point's without a ``tool``, metres; 0 while it is free.
    ``moved`` as for :func:`pressed_depth`.
    """
    if not finger.touching:
        return 0.0
    if tool is None:
        return float(np.linalg.norm(np.asarray(finger.probe) - np.asarray(finger.proxy)))
    pose = Pose(np.asarray(finger.probe), np.asarray(finger.orientation))
    return pressed_depth(mesh, tool, pose, np.asarray(finger.point_forces).sum(axis=0), moved)


def pressed_depth(mesh: TetMesh, tool: Tool, pose: Pose, push: Array, moved: Array | None) -> float:
    """Depth of a tool along its ``push`` (3,), the force on the body, newton; metres, 0 without
    one. ``moved`` are displacements (n, 3), metres, whose largest says how far in it may be; None
    of a body at rest.
    """
    strength = float(np.linalg.norm(push))
    if strength == 0.0:
        return 0.0
    farthest = 0.0 if moved is None else FARTHEST * float(np.linalg.norm(moved, axis=1).max())
    inward = push / strength
    return depth_of(tool, pose, inward, mesh.nodes, mesh.surface_triangles, farthest)


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
