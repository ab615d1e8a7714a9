"""Several fingers on one body: each feels the others through it. Continues equation (10).

Every contact point p moves by the forces on all of them, u_p = sum_q C_pq F_q / E, with
C_pq = sum_ab a_pa a_qb L_ab over the nodes of the two triangles. Solved for the forces this is (10)
on nodes, and its extension to places on triangles.

*A finger may only push.* The force of a finger stays within a cone around the direction in which it
pushes; where the others draw the surface away from it, it becomes zero. The forces are those that
minimise the convex function 1/2 F.C F - F.u under these cones, so that they are unique and change
continuously with displacements and places; while no finger slides on its cone they are the gradient
of an energy.

*Fingers on one place* cannot be told apart by the surface, so that C is singular. What they do to
each other is then reduced by at most the share `DISTINCT`; see :func:`told_apart`. The page
``docs/contact.md`` has the formulas and limits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Where the others hold a finger, it must still find this share of the compliance it finds alone.
DISTINCT = 0.02

# C_pp is enlarged by this share before looking for what is missing: far less than DISTINCT, far
# more than what rounding and compression leave of a zero.
TELLING_SHIFT = 1e-3

# A cone is never narrower than this tangent of its half angle.
NARROWEST_CONE = 1.0

# Forces are taken as found when they miss their conditions by this share of the largest one. Rounds
# are a few as a rule; the bound only makes sure of an end.
CONVERGED = 1e-12
MOST_ROUNDS = 1000


def coupled_compliance(blocks: ArrayLike, alphas: ArrayLike) -> NDArray[np.float64]:
    """C_pq = sum_ab a_pa a_qb L_ab, (m, m, 3, 3), of m contact points.

    ``blocks`` (m, 3, m, 3, 3, 3) holds L between node a of contact p and node b of contact q at
    [p, a, q, b], ``alphas`` (m, 3) the area coordinates.
    """
    weights = np.asarray(alphas, dtype=np.float64)
    between = np.asarray(blocks, dtype=np.float64)
    compliance: NDArray[np.float64] = np.einsum("pa,paqbij,qb->pqij", weights, between, weights)
    return compliance


def told_apart(compliance: NDArray[np.float64]) -> NDArray[np.float64]:
    """C with contacts that the surface can hardly tell apart made distinct, (m, m, 3, 3).

    What contact p yields while all others are held is the inverse of the block pp of C^-1. Its
    share of C_pp, what p yields alone, is measured by the harmonic mean y of the three principal
    ones. Where y is below `DISTINCT`, what p and the others do to each other is reduced::

        C_pq t_p t_q    t_p^2 = 1 - max(0, DISTINCT - y_p)    p != q

    It stays positive definite: it is the sum of t C t and of (1 - t_p^2) C_pp. No finger is firmer
    against the others than 1 / `DISTINCT` times as firm as alone, and one that carries all alone
    does not notice. Contacts well apart get exactly C.
    """
    count = len(compliance)
    if count == 1:
        return compliance
    each = np.arange(count)
    own = compliance[each, each]
    shifted = compliance.copy()
    shifted[each, each] *= 1.0 + TELLING_SHIFT
    held = np.linalg.inv(as_matrix(shifted)).reshape(count, 3, count, 3)
    yielded = 3.0 / np.einsum("pij,pjpi->p", own, held) - TELLING_SHIFT
    t = np.sqrt(1.0 - np.clip(DISTINCT - yielded, 0.0, DISTINCT))
    distinct: NDArray[np.float64] = compliance * (t[:, None] * t)[:, :, None, None]
    distinct[each, each] = own
    return distinct


def solve_contacts(
    compliance: ArrayLike,
    displacements: ArrayLike,
    pushes: ArrayLike | None = None,
    start: ArrayLike | None = None,
) -> NDArray[np.float64]:
    """Forces (m, 3) on the body of fingers that may only push, at E = 1.

    Parameters
    ----------
    compliance : (m, m, 3, 3), see :func:`coupled_compliance`.
    displacements : (m, 3), how far each finger asks its contact point to move from rest.
    pushes : (m, 3), the part of it that the finger adds to what the others do; gives the cone of
        its force. The whole displacement unless given. A finger with none has no force.
    start : (m, 3), forces of the tick before; only the time to converge depends on them.
    """
    u = np.asarray(displacements, dtype=np.float64)
    return solve_distinct(
        told_apart(np.asarray(compliance, dtype=np.float64)),
        u,
        u if pushes is None else np.asarray(pushes, dtype=np.float64),
        None if start is None else np.asarray(start, dtype=np.float64),
    )


def solve_distinct(
    C: NDArray[np.float64],
    u: NDArray[np.float64],
    pushes: NDArray[np.float64],
    start: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """As :func:`solve_contacts`, for a C that has been :func:`told_apart`."""
    axes, widths = push_cones(C, pushes)
    return solve_with_cones(C, u, axes, widths, start)


def solve_with_cones(
    C: NDArray[np.float64],
    u: NDArray[np.float64],
    axes: NDArray[np.float64],
    widths: NDArray[np.float64],
    start: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """As :func:`solve_distinct`, in cones that are given; see :func:`push_cones`."""
    pressing = Pressing(C, u, axes, widths)
    direct = np.asarray(np.linalg.solve(as_matrix(C), u.ravel()), dtype=np.float64)
    forces = direct.reshape(u.shape)
    if (pressing.projected(forces) == forces).all():
        return forces
    return _in_rounds(pressing, forces if start is None else start)


def push_cones(
    compliance: NDArray[np.float64], pushes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Axes (m, 3) and tangents of half angles (m,) of the cones that the forces stay in.

    The axis is the direction of the push, zero without one. A cone is twice as wide as the force of
    its finger alone needs, so that no finger is ever limited while it is alone.
    """
    size = np.linalg.norm(pushes, axis=1)
    axes = np.divide(pushes, size[:, None], out=np.zeros_like(pushes), where=size[:, None] > 0)
    each = np.arange(len(pushes))
    alone = np.linalg.solve(compliance[each, each], axes[:, :, None])[:, :, 0]
    along = np.einsum("px,px->p", alone, axes)
    across = np.linalg.norm(alone - along[:, None] * axes, axis=1)
    ratio = np.divide(across, along, out=np.zeros_like(along), where=along > 0)
    return axes, np.maximum(NARROWEST_CONE, 2.0 * ratio)


def onto_cone(
    force: NDArray[np.float64], axis: NDArray[np.float64], width: float
) -> NDArray[np.float64]:
    """The force nearest to ``force`` (3,) in the cone about ``axis`` (3,); zero for no axis."""
    along = float(force @ axis)
    tangential = force - along * axis
    across = float(np.linalg.norm(tangential))
    if not axis.any() or along <= -width * across:
        return np.zeros(3)
    if across <= width * along:
        return force
    length = (along + width * across) / (1.0 + width * width)
    nearest: NDArray[np.float64] = length * axis + (width * length / across) * tangential
    return nearest


def cone_derivative(
    force: NDArray[np.float64], axis: NDArray[np.float64], width: float
) -> NDArray[np.float64]:
    """Derivative (3, 3) of :func:`onto_cone`; times the force itself it gives the projection."""
    along = float(force @ axis)
    tangential = force - along * axis
    across = float(np.linalg.norm(tangential))
    if not axis.any() or along <= -width * across:
        return np.zeros((3, 3))
    if across <= width * along:
        return np.eye(3)
    sideways = tangential / across
    edge = axis + width * sideways
    share = 1.0 / (1.0 + width * width)
    turning = width * share * (along + width * across) / across
    around = np.eye(3) - np.outer(axis, axis) - np.outer(sideways, sideways)
    derivative: NDArray[np.float64] = share * np.outer(edge, edge) + turning * around
    return derivative


@dataclass(frozen=True, eq=False)
class Pressing:
    """Forces F are sought that minimise 1/2 F.C F - F.u, each in its cone.

    Attributes
    ----------
    C : (m, m, 3, 3), symmetric and positive definite.
    u : (m, 3), displacements asked for.
    axes : (m, 3), of the cones; zero where there can be no force.
    widths : (m,), tangents of the cones' half angles.
    """

    C: NDArray[np.float64]
    u: NDArray[np.float64]
    axes: NDArray[np.float64]
    widths: NDArray[np.float64]

    def short(self, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """What the contact points lack to the displacements asked for, u - C F, (m, 3)."""
        lacking: NDArray[np.float64] = self.u - np.einsum("pqij,qj->pi", self.C, forces)
        return lacking

    def energy(self, forces: NDArray[np.float64]) -> float:
        """1/2 F.C F - F.u."""
        return -0.5 * float(np.sum(forces * (self.short(forces) + self.u)))

    def projected(self, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """The nearest forces in the cones."""
        return np.array(
            [onto_cone(*one) for one in zip(forces, self.axes, self.widths, strict=True)]
        )

    def steps(self) -> NDArray[np.float64]:
        """Newton per metre, about the firmness of each finger alone, (m,)."""
        firmness: NDArray[np.float64] = 3.0 / np.einsum("ppii->p", self.C)
        return firmness

    def missing(self, forces: NDArray[np.float64]) -> float:
        """The largest part of F - onto_cone(F + t (u - C F)), zero for the answer alone."""
        ahead = forces + self.steps()[:, None] * self.short(forces)
        return float(np.abs(forces - self.projected(ahead)).max())


def _in_rounds(pressing: Pressing, start: NDArray[np.float64]) -> NDArray[np.float64]:
    """Newton steps where they lead on, with a sweep after each that always does."""
    forces, least = pressing.projected(start), np.inf
    for _ in range(MOST_ROUNDS):
        further = newton_step(pressing, forces)
        missing = pressing.missing(further)
        if missing <= CONVERGED * np.abs(further).max():
            return further
        if missing <= 0.5 * least or pressing.energy(further) < pressing.energy(forces):
            forces, least = further, min(least, missing)
        forces = sweep(pressing, forces)
    return forces


def newton_step(pressing: Pressing, forces: NDArray[np.float64]) -> NDArray[np.float64]:
    """A semismooth Newton step for F = onto_cone(F + t (u - C F)), projected onto the cones.

    The projection P is homogeneous, P(z) = J z with its derivative J, so that the step solves
    (1 - J + J t C) F = J t u: (10) for fingers within their cones, F = 0 for those let go.
    """
    t = pressing.steps()
    ahead = forces + t[:, None] * pressing.short(forces)
    count = len(forces)
    derivative = np.zeros((3 * count, 3 * count))
    for p in range(count):
        own = slice(3 * p, 3 * p + 3)
        derivative[own, own] = cone_derivative(
            ahead[p], pressing.axes[p], float(pressing.widths[p])
        )
    scaled = np.repeat(t, 3)
    system = np.eye(3 * count) - derivative
    system += derivative @ (scaled[:, None] * as_matrix(pressing.C))
    found = np.linalg.solve(system, derivative @ (scaled * pressing.u.ravel()))
    return pressing.projected(np.asarray(found, dtype=np.float64).reshape(count, 3))


def sweep(pressing: Pressing, start: NDArray[np.float64]) -> NDArray[np.float64]:
    """Projected block Gauss-Seidel, once over all fingers; the energy never rises.

    A finger takes the force that meets its displacement given the others', where its cone has it;
    otherwise a step down the gradient, short enough to lead down, projected onto the cone.
    """
    forces = start.copy()
    for p, (axis, width) in enumerate(zip(pressing.axes, pressing.widths, strict=True)):
        own = pressing.C[p, p]
        short = pressing.u[p] - np.einsum("qij,qj->i", pressing.C[p], forces)
        wanted = forces[p] + np.linalg.solve(own, short)
        nearest = onto_cone(wanted, axis, float(width))
        if (nearest == wanted).all():
            forces[p] = wanted
        else:
            forces[p] = onto_cone(forces[p] + short / float(np.trace(own)), axis, float(width))
    return forces


def as_matrix(compliance: NDArray[np.float64]) -> NDArray[np.float64]:
    """Blocks (m, m, 3, 3) as one matrix (3m, 3m)."""
    size = 3 * len(compliance)
    return compliance.transpose(0, 2, 1, 3).reshape(size, size)
