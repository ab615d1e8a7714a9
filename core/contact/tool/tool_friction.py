"""Coulomb friction between a tool and the contact points.

Each point carries a force aside, F_t, of at most the friction coefficient times its push. Where it
is less, the point sticks: it stays with its anchor, the place on the tool where it was. Where it is
that much, the point slips, and its anchor follows it. For given pushes the forces aside are those
of least energy within their discs (Tresca's problem, convex); for given forces aside the pushes are
those of the complementarity problem. Solved in turns (P. D. Panagiotopoulos, 1975), about a
linearisation of the distance that is taken anew each time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .tool_law import MOST_LINEARISATIONS, Candidates, Settled, linearised, pushes_about
from .tools import Pose, Tool

# Steps of the accelerated projected gradient for the forces aside, each time they are asked for.
STEPS_ASIDE = 30

# Displacements that change by less than this share of the tool's size have been found.
CONVERGED = 1e-11

# A force aside within this share of its limit slips.
SLIPPING = 1.0 - 1e-7


@dataclass(frozen=True, eq=False)
class Rubbing:
    """Friction of a tool's candidates.

    Attributes
    ----------
    coefficient : of friction, >= 0.
    anchors : float64 (p, 3), where on the tool each point stuck, in the body's coordinates at the
        tool's pose; NaN for points that were not touched, which feel no friction yet.
    """

    coefficient: float
    anchors: NDArray[np.float64]


def settle_rubbing(
    candidates: Candidates,
    tool: Tool,
    pose: Pose,
    forces: NDArray[np.float64],
    rubbing: Rubbing,
    most: int = MOST_LINEARISATIONS,
) -> Settled:
    """Find the equilibrium with friction, beginning with ``forces`` (p, 3)."""
    displacements = candidates.displacements(forces)
    known = np.isfinite(rubbing.anchors.sum(axis=1))
    normals = np.zeros_like(forces)
    pushes, into = np.linalg.norm(forces, axis=1), forces
    for made in range(1, most + 1):
        places = candidates.positions + displacements
        distances, normals = linearised(tool, pose, places, candidates.normals, into)
        aside = _across(forces, normals) * known[:, None]
        # What the forces aside move counts as given, like the other fingers'.
        given = displacements - candidates.displacements(aside)
        pushes = pushes_about(candidates, given, distances, normals, pushes)
        limits = rubbing.coefficient * pushes * known
        aside = _aside(candidates, normals, pushes, limits, rubbing.anchors, aside)
        into = pushes[:, None] * normals
        forces = into + aside
        last, displacements = displacements, candidates.displacements(forces)
        change = float(np.abs(displacements - last).max(initial=0.0))
        if change <= CONVERGED * tool.size:
            return Settled(forces, pushes, normals, displacements, made, exact=True)
    return Settled(forces, pushes, normals, displacements, most, exact=False)


def moved_anchors(
    settled: Settled, candidates: Candidates, rubbing: Rubbing
) -> NDArray[np.float64]:
    """Anchors (p, 3) after the tick: those of points that stuck stay, others are where they are."""
    places = candidates.positions + settled.displacements
    aside = np.linalg.norm(_across(settled.forces, settled.normals), axis=1)
    sticks = aside < SLIPPING * rubbing.coefficient * settled.pushes
    sticks &= np.isfinite(rubbing.anchors.sum(axis=1))
    return np.where(sticks[:, None], rubbing.anchors, places)


def _aside(
    candidates: Candidates,
    normals: NDArray[np.float64],
    pushes: NDArray[np.float64],
    limits: NDArray[np.float64],
    anchors: NDArray[np.float64],
    start: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Forces aside (p, 3) within ``limits`` (p,) that bring the points nearest to their anchors."""
    rubbed = np.flatnonzero(limits > 0.0)
    aside = np.zeros_like(start)
    if not rubbed.size:
        return aside
    own = (3 * rubbed[:, None] + np.arange(3)).reshape(-1)
    matrix = candidates.compliance[np.ix_(own, own)]
    normal, limit = normals[rubbed], limits[rubbed]
    pushed = candidates.displacements(pushes[:, None] * normals)
    away = (candidates.positions + pushed - anchors)[rubbed]
    step = 1.0 / float(np.linalg.norm(matrix, 2))
    forces = _within(_across(start[rubbed], normal), limit)
    ahead, weight = forces, 1.0
    for _ in range(STEPS_ASIDE):
        slip = away + (matrix @ ahead.reshape(-1)).reshape(-1, 3)
        nearer = _within(_across(ahead - step * slip, normal), limit)
        # Nesterov's acceleration, begun anew where it would lead back (O'Donoghue, Candes 2015).
        if ((ahead - nearer) * (nearer - forces)).sum() > 0.0:
            weight = 1.0
        grown = 0.5 * (1.0 + np.sqrt(1.0 + 4.0 * weight * weight))
        ahead = nearer + (weight - 1.0) / grown * (nearer - forces)
        forces, weight = nearer, grown
    aside[rubbed] = forces
    return aside


def _across(forces: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """The parts (p, 3) of forces across normals (p, 3)."""
    along = np.einsum("px,px->p", forces, normals)
    across: NDArray[np.float64] = forces - along[:, None] * normals
    return across


def _within(forces: NDArray[np.float64], limits: NDArray[np.float64]) -> NDArray[np.float64]:
    """Forces (p, 3) shortened to ``limits`` (p,)."""
    lengths = np.linalg.norm(forces, axis=1)
    shares = np.divide(limits, lengths, out=np.ones_like(limits), where=lengths > limits)
    shortened: NDArray[np.float64] = forces * shares[:, None]
    return shortened
