"""Which contact points of a body may carry a tool's force, and how far they give way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..near_field.compliance_beneath import point_compliance
from .tool_law import Settled, distances_in_body
from .tool_touch import Load, ToolTouch
from .tools import Pose

# Points at rest within this share of the tool's size are looked at from the start; others when
# they are found to have moved into the tool.
MARGIN = 0.1

# A point counts as in the tool below this share of its size.
IN_TOOL = 1e-9


def looked_at(state: ToolTouch, pose: Pose, moved: NDArray[np.float64]) -> NDArray[np.int64]:
    """Points that may be touched: those in or near the tool, at rest or as others have moved them,
    (P, 3), and those pressed before.
    """
    tool, margin = state.tool, MARGIN * state.tool.size
    looked_at = state.points
    for places in (state.surface.positions, state.surface.positions + moved):
        within = np.flatnonzero(
            np.linalg.norm(places - pose.position, axis=1) < tool.reach + margin
        )
        distances, _ = distances_in_body(tool, pose, places[within])
        looked_at = np.union1d(within[distances < margin], looked_at)
    return looked_at


def points_entered(
    state: ToolTouch,
    pose: Pose,
    chosen: NDArray[np.int64],
    settled: Settled,
    offsets: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Points not looked at so far that have been moved into the tool, by others by ``offsets``."""
    surface, tool = state.surface, state.tool
    pressed = settled.pushes > 0.0
    farthest = float(np.linalg.norm(settled.displacements, axis=1).max(initial=0.0))
    farthest += float(np.linalg.norm(offsets, axis=1).max(initial=0.0))
    away = np.linalg.norm(surface.positions - pose.position, axis=1)
    others = np.setdiff1d(np.flatnonzero(away < tool.reach + farthest), chosen)
    rest, _ = distances_in_body(tool, pose, surface.positions[others])
    others = others[rest < farthest]
    if not others.size:
        return others
    moved = offsets[others]
    if pressed.any():
        response = compliance_between(state, others, chosen[pressed])
        moved += (response @ settled.forces[pressed].reshape(-1)).reshape(-1, 3)
    distances, _ = distances_in_body(tool, pose, surface.positions[others] + moved)
    entered: NDArray[np.int64] = others[distances < -IN_TOOL * tool.size]
    return entered


def moved_by(
    state: ToolTouch, chosen: NDArray[np.int64], outside: Load | None
) -> NDArray[np.float64]:
    """Displacements (k, 3) of the chosen points under the forces of other fingers."""
    offsets = np.zeros((len(chosen), 3))
    if outside is None or not len(outside.nodes):
        return offsets
    body = state.body
    loaded = body.free_index(outside.nodes)
    held = loaded >= 0
    moved = body.compliance.apply(outside.forces[held] / state.young_modulus, loaded[held])
    # The last row stands for pinned nodes, which others do not move.
    moved = np.vstack([moved, np.zeros((1, 3))])
    corners = body.free_index(body.mesh.surface_triangles[state.surface.triangles[chosen]])
    at_points: NDArray[np.float64] = np.einsum(
        "pc,pcx->px", state.surface.alphas[chosen], moved[corners]
    )
    return at_points


def compliance_between(
    state: ToolTouch, rows: NDArray[np.int64], columns: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Displacements of points ``rows`` (k,) per force on points ``columns`` (l,), (3k, 3l), m/N."""
    blocks = point_compliance(state.body, state.surface, rows, columns, state.correction)
    matrix: NDArray[np.float64] = blocks.transpose(0, 2, 1, 3).reshape(3 * len(rows), -1)
    return matrix / state.young_modulus
