"""The law of contact between a rigid tool and the contact points of a soft body.

The body answers linearly, u = C F / E; the tool's shape is exact. Without friction each point's
force pushes along the tool's normal where the point has gone to,

    F_i = f_i n_i,  n_i = grad phi(x_i + u_i),  f_i >= 0,  phi(x_i + u_i) >= 0,  one of both zero.

Those are the conditions for least elastic energy among all shapes that stay out of the tool
(Karush, Kuhn and Tucker). So the forces on the tool are the slope of an energy in the tool's pose,
and in balance with those on the body. They are found by linearising the distance about the last
displacements: one complementarity problem each time, whose matrix N' C N is symmetric and positive
definite. The iteration contracts wherever the equilibrium is stable; :mod:`.tilt` keeps it so
beyond depths of about half a sphere's radius.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..complementarity import solve_complementarity
from .tilt import held_tilt, hold
from .tools import Pose, Tool

# Linearisations; five to thirty are usual, the more the deeper the tool in relation to its radius.
MOST_LINEARISATIONS = 400

# Displacements that change by less than this share of the tool's size have been found.
CONVERGED = 1e-13


@dataclass(frozen=True, eq=False)
class Candidates:
    """Contact points that a tool might touch, and how they give way.

    Attributes
    ----------
    positions : float64 (p, 3), places at rest, metres.
    normals : float64 (p, 3), outward normals of the body there.
    compliance : float64 (3p, 3p), displacements per newton at the body's modulus, m/N.
    offsets : float64 (p, 3), displacements that other forces cause there, metres.
    """

    positions: NDArray[np.float64]
    normals: NDArray[np.float64]
    compliance: NDArray[np.float64]
    offsets: NDArray[np.float64]

    def displacements(self, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where ``forces`` (p, 3) and the other forces move the points to, (p, 3)."""
        moved = (self.compliance @ forces.reshape(-1)).reshape(-1, 3)
        return moved + self.offsets


@dataclass(frozen=True, eq=False)
class Settled:
    """Equilibrium of the candidates with a tool.

    Attributes
    ----------
    forces : float64 (p, 3) on the body, newton.
    pushes : float64 (p,), their part along the tool's normal, all >= 0.
    normals : float64 (p, 3), outward from the tool, at the displaced points.
    displacements : float64 (p, 3), metres.
    linearisations : how many were needed.
    exact : whether the displacements stopped changing within the bound.
    """

    forces: NDArray[np.float64]
    pushes: NDArray[np.float64]
    normals: NDArray[np.float64]
    displacements: NDArray[np.float64]
    linearisations: int
    exact: bool


def settle(
    candidates: Candidates,
    tool: Tool,
    pose: Pose,
    forces: NDArray[np.float64],
    most: int = MOST_LINEARISATIONS,
) -> Settled:
    """Find the frictionless equilibrium, beginning with ``forces`` (p, 3)."""
    return settle_together(candidates, [(tool, pose, slice(None))], forces, most)


def settle_together(
    candidates: Candidates,
    tools: Sequence[tuple[Tool, Pose, slice]],
    forces: NDArray[np.float64],
    most: int = MOST_LINEARISATIONS,
) -> Settled:
    """As :func:`settle` for several tools, each with its pose and its part of the candidates."""
    pushes = np.linalg.norm(forces, axis=1)
    displacements = candidates.displacements(forces)
    normals, distances = np.zeros_like(forces), np.zeros(len(forces))
    limit = CONVERGED * min(tool.size for tool, _, _ in tools)
    for made in range(1, most + 1):
        for tool, pose, part in tools:
            distances[part], normals[part] = linearised(
                tool,
                pose,
                candidates.positions[part] + displacements[part],
                candidates.normals[part],
                forces[part],
            )
        pushes = pushes_about(candidates, displacements, distances, normals, pushes)
        forces = pushes[:, None] * normals
        last, displacements = displacements, candidates.displacements(forces)
        change = float(np.abs(displacements - last).max(initial=0.0))
        if change <= limit:
            return Settled(forces, pushes, normals, displacements, made, exact=True)
    return Settled(forces, pushes, normals, displacements, most, exact=False)


def linearised(
    tool: Tool,
    pose: Pose,
    places: NDArray[np.float64],
    facing: NDArray[np.float64],
    forces: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances (p,) and normals (p, 3) of a tool at ``places`` (p, 3), where the points are now.

    ``forces`` (p, 3) are the last pushes on points with outward normals ``facing`` (p, 3), which
    tell the direction that pushes are held near.
    """
    distances, normals = distances_in_body(tool, pose, places)
    offsets = places[:, None] - pose.to_body(tool.core)
    return held_tilt(distances, normals, offsets, facing, hold(forces, facing), tool.radius)


def distances_in_body(
    tool: Tool, pose: Pose, points: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Signed distances (p,) of points (p, 3) from the posed tool, and normals (p, 3), in the body's
    coordinates.
    """
    distances, normals = tool.distance(pose.to_tool(points))
    return distances, normals @ pose.rotation.T


def along_normals(
    compliance: NDArray[np.float64], normals: NDArray[np.float64]
) -> NDArray[np.float64]:
    """N' C N (p, p): displacement of each point along its normal per push on each other."""
    count = len(normals)
    turned = np.einsum("ix,ixjy->ijy", normals, compliance.reshape(count, 3, count, 3))
    matrix = np.einsum("ijy,jy->ij", turned, normals)
    symmetric: NDArray[np.float64] = 0.5 * (matrix + matrix.T)
    return symmetric


def pushes_about(
    candidates: Candidates,
    displacements: NDArray[np.float64],
    distances: NDArray[np.float64],
    normals: NDArray[np.float64],
    start: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Pushes (p,) of the complementarity problem of the distances linearised about
    ``displacements`` (p, 3), which these pushes and the other fingers cause.
    """
    moved = displacements - candidates.offsets
    gaps = distances - np.einsum("px,px->p", normals, moved)
    matrix = along_normals(candidates.compliance, normals)
    return solve_complementarity(matrix, gaps, start).forces
