"""Several fingers on one body: each feels the others through it. Continues equation (10).

Every contact point p moves by the forces on all of them, u_p = sum_q C_pq F_q / E, with
C_pq = sum_ab a_pa a_qb L_ab over the nodes of the two triangles. Solved for the forces this is (10)
on nodes, and its extension to places on triangles.

*A finger may only push.* The force of a finger stays within a cone around the direction in which it
pushes; where the others draw the surface away from it, it becomes zero. The forces are those that
minimise the convex function 1/2 F.C F - F.u under these cones, so that they are unique, change
continuously with displacements and places, and are the gradient of an energy.

*Fingers on one place* cannot be told apart by the surface, so that C is singular. Each finger is
given as much compliance of its own as is missing to `DISTINCT` of what it feels alone, and none
where it has that much. ``docs/contact.md`` has the formulas and limits.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Where the others hold a finger, it must still find this share of the compliance it finds alone.
DISTINCT = 0.02

# Added to C before looking for what is missing, as a share of its diagonal: far less than DISTINCT,
# far more than what rounding and compression leave of a zero.
TELLING_SHIFT = 1e-3

# A cone is never narrower than this tangent of its half angle.
NARROWEST_CONE = 1.0

# Sweeps over all fingers until nothing changes any more, beyond what any set of fingers needs.
MOST_SWEEPS = 20_000
CONVERGED = 1e-13


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

    What contact p yields while all others are held is the inverse of the block pp of C^-1. Where
    the harmonic mean of its three principal compliances is below `DISTINCT` of the mean ones that p
    has alone, p gets the rest as a compliance of its own. Contacts well apart get exactly C.
    """
    count = len(compliance)
    own = np.trace(compliance, axis1=2, axis2=3).diagonal() / 3.0
    shifted = _matrix(compliance) + TELLING_SHIFT * np.diag(np.repeat(own, 3))
    held = np.linalg.inv(shifted).reshape(count, 3, count, 3)
    yielded = 3.0 / np.einsum("papa->p", held) - TELLING_SHIFT * own
    missing = np.where(count > 1, np.maximum(0.0, DISTINCT * own - yielded), 0.0)
    distinct = compliance.copy()
    each = np.arange(count)
    distinct[each, each] += missing[:, None, None] * np.eye(3)
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
    C = told_apart(np.asarray(compliance, dtype=np.float64))
    u = np.asarray(displacements, dtype=np.float64)
    pushed = u if pushes is None else np.asarray(pushes, dtype=np.float64)
    axes, widths = push_cones(C, pushed)
    direct = np.asarray(np.linalg.solve(_matrix(C), u.ravel()), dtype=np.float64).reshape(u.shape)
    if (_inside(direct, axes, widths) & axes.any(axis=1)).all():
        return direct
    forces = np.zeros_like(u) if start is None else np.asarray(start, dtype=np.float64)
    return _swept(C, u, axes, widths, forces)


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


def _inside(
    forces: NDArray[np.float64], axes: NDArray[np.float64], widths: NDArray[np.float64]
) -> NDArray[np.bool_]:
    along = np.einsum("px,px->p", forces, axes)
    across = np.linalg.norm(forces - along[:, None] * axes, axis=1)
    inside: NDArray[np.bool_] = across <= widths * along
    return inside


def _swept(
    C: NDArray[np.float64],
    u: NDArray[np.float64],
    axes: NDArray[np.float64],
    widths: NDArray[np.float64],
    start: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Projected block Gauss-Seidel. No step raises the energy, so that any sweep may be the last.

    A finger takes the force that meets its displacement given the others', where its cone has it;
    otherwise a step down the gradient, projected onto the cone.
    """
    count = len(u)
    inverses = [np.linalg.inv(C[p, p]) for p in range(count)]
    steps = [1.0 / float(np.linalg.eigvalsh(C[p, p])[-1]) for p in range(count)]
    forces = np.array([onto_cone(*one) for one in zip(start, axes, widths, strict=True)])
    for _ in range(MOST_SWEEPS):
        before = forces.copy()
        for p in range(count):
            residual = u[p] - np.einsum("qij,qj->i", C[p], forces)
            wanted = forces[p] + inverses[p] @ residual
            if _inside(wanted[None], axes[p][None], widths[p][None])[0] and axes[p].any():
                forces[p] = wanted
            else:
                forces[p] = onto_cone(forces[p] + steps[p] * residual, axes[p], float(widths[p]))
        if np.abs(forces - before).max() <= CONVERGED * np.abs(forces).max():
            break
    return forces


def _matrix(compliance: NDArray[np.float64]) -> NDArray[np.float64]:
    """Blocks (m, m, 3, 3) as one matrix (3m, 3m)."""
    size = 3 * len(compliance)
    return compliance.transpose(0, 2, 1, 3).reshape(size, size)
