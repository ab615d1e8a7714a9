"""How a tool gets to where it shall be: in strides, from outside the body."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from ...errors import PalpateError
from ...mesh.surface import Surface
from ...mesh.winding_volume import is_inside
from .tool_law import distances_in_body
from .tool_touch import ToolTouch
from .tools import Pose, Tool

# Strides within which any tool is outside any body: a path this long leads out.
MOST_STRIDES = 2000


def stride(tool: Tool, start: Pose, goal: Pose) -> tuple[Pose, bool]:
    """The pose one stride from ``start`` towards ``goal``, and whether that is the goal.

    A turn counts as the way of the tool's farthest point.
    """
    way = goal.position - start.position
    turn = Rotation.from_matrix(goal.rotation @ start.rotation.T).as_rotvec()
    length = float(np.linalg.norm(way) + np.linalg.norm(turn) * tool.reach)
    if length <= tool.stride * (1.0 + 1e-12):
        return goal, True
    share = tool.stride / length
    turned = Rotation.from_rotvec(share * turn).as_matrix() @ start.rotation
    return Pose(start.position + share * way, turned), False


def too_far(tool: Tool) -> PalpateError:
    """What is wrong with a pose that is too many strides away."""
    return PalpateError(
        "tool {name}: the pose is more than {most} strides away; begin nearer",
        name=tool.name,
        most=MOST_STRIDES,
    )


def is_outside(state: ToolTouch, pose: Pose) -> bool:
    """Whether the tool is clear of the body at rest: no point in it, nor it in the body."""
    return overlap(state, pose) <= 0.0 and not is_within(state, pose)


def overlap(state: ToolTouch, pose: Pose) -> float:
    """How deep, in metres, the body at rest lies in the tool."""
    distances, _ = distances_in_body(state.tool, pose, state.surface.positions)
    return -float(distances.min())


def is_within(state: ToolTouch, pose: Pose) -> bool:
    """Whether the middle of the tool is in the body at rest."""
    middle = pose.position + pose.rotation @ state.tool.core.mean(axis=0)
    mesh = state.body.mesh
    return bool(is_inside(middle[None], Surface(mesh.nodes, mesh.surface_triangles))[0])


def way_out(state: ToolTouch, pose: Pose) -> Pose:
    """The nearest pose outside the body in the direction in which the body would push the tool."""
    surface = state.surface
    distances, _ = distances_in_body(state.tool, pose, surface.positions)
    depths = np.maximum(-distances, 0.0) * surface.areas
    push = depths @ surface.normals
    length = float(np.linalg.norm(push))
    # Pushed alike from all sides: through the nearest one.
    nearest = int(distances.argmin())
    direction = push / length if length > 0.0 else surface.normals[nearest]
    for strides in range(1, MOST_STRIDES):
        away = pose.position + strides * state.tool.stride * direction
        if is_outside(state, Pose(away, pose.rotation)):
            return Pose(away, pose.rotation)
    raise PalpateError(
        "tool {name}: there is no way out of the body from where it is; begin outside",
        name=state.tool.name,
    )
