"""The corrected force of points, slowly and in numpy: what the native one is compared with.

The relation of one place is that of :mod:`palpate.core.shape.force_at_depth.felt_force`. Fingers
that hold each other through the body get less of it, the more strongly they are coupled::

    m_p = sum_q sqrt(tr(M C_pq C_qq^-1 C_qp) / tr(M C_pp))        M = b b^T + 0.05 w K_p / k
    b' = s b        w' = max(s w, k b'.C_pp b' r)                 1 + 1/r = m^(-1/3)

with s = 1 up to m = WEAK, 0 from STRONG on and a smooth step between. Each softens its own place;
what it does to the others' stays linear.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from palpate.core.contact.equations import contact_compliance
from palpate.core.shape.force_at_depth.felt_force import LEAST_SHARE

# Couplings (m) between which the share of the correction goes from all to nothing.
WEAK, STRONG = 0.35, 0.65
# Weight of all directions beside that of b, in parts of w.
SIDEWAYS = 0.05


@dataclass(frozen=True, eq=False)
class Relation:
    """Between the displacement of a contact point and the force that moves it so far.

    Attributes
    ----------
    stiffness : K (3, 3), symmetric and positive definite, newton per metre.
    softening : b (3,), 1/metre.
    saturation : w, 1/metre^2, not negative.
    """

    stiffness: np.ndarray
    softening: np.ndarray
    saturation: float

    def energy(self, displacement: np.ndarray) -> float:
        """Work to move the contact point by u (3,), joule."""
        u = np.asarray(displacement, dtype=np.float64)
        linear = 0.5 * float(u @ self.stiffness @ u)
        return LEAST_SHARE * linear + (1.0 - LEAST_SHARE) * self.softened(u)[0]

    def force(self, displacement: np.ndarray) -> np.ndarray:
        """Force (3,) on the body that moves the contact point by u (3,), newton."""
        u = np.asarray(displacement, dtype=np.float64)
        linear = self.stiffness @ u
        force: np.ndarray = LEAST_SHARE * linear + (1.0 - LEAST_SHARE) * self._softened_force(u)
        return force

    def tangent(self, displacement: np.ndarray) -> np.ndarray:
        """Derivative (3, 3) of :meth:`force`, symmetric and positive definite."""
        u = np.asarray(displacement, dtype=np.float64)
        force, root = self._softened_force(u), self.softened(u)[1]
        both = np.outer(self.softening, force)
        softened = self.stiffness - both - both.T
        softened -= self.saturation / self.mean_stiffness * np.outer(force, force)
        tangent: np.ndarray = LEAST_SHARE * self.stiffness + (1.0 - LEAST_SHARE) / root * softened
        return tangent

    @property
    def mean_stiffness(self) -> float:
        """Mean stiffness k = tr K / 3, newton per metre."""
        return float(np.trace(self.stiffness)) / 3.0

    def softened(self, u: np.ndarray) -> tuple[float, float]:
        """Phi and S at a displacement u (3,), joule and a number."""
        twice = float(u @ self.stiffness @ u)
        t = 1.0 + float(self.softening @ u)
        root = float(np.sqrt(t * t + self.saturation * twice / self.mean_stiffness))
        # Each form loses digits where the other one keeps them.
        if t > 0.0:
            return twice / (root + t), root
        return self.mean_stiffness / self.saturation * (root - t), root

    def _softened_force(self, u: np.ndarray) -> np.ndarray:
        energy, root = self.softened(u)
        force: np.ndarray = (self.stiffness @ u - energy * self.softening) / root
        return force


def relation_at(body, softenings, triangle, alpha, mode="consistent"):
    """The relation of a place on a body of 1 Pa, given b and w of every surface node, (s, 4)."""
    local = body.mesh.surface_local_triangles[triangle]
    if mode == "paper":
        stiffness = np.einsum("a,aij->ij", alpha, body.contact_blocks[local])
    else:
        inverse = np.linalg.inv(contact_compliance(body.surface_blocks(local, local), alpha))
        stiffness = 0.5 * (inverse + inverse.T)
    mixed = np.asarray(alpha) @ softenings[local]
    return Relation(stiffness, mixed[:3], float(mixed[3]))


def corrected_forces(body, softenings, triangle, alpha, u, mode="consistent"):
    """Forces (3, 3) on the triangle's nodes that move a place by u (3,).

    In mode ``consistent`` the nodes share the force by the area coordinates. In mode ``paper`` each
    bears what is its own: ``a (c K_a u + (1 - c) (K_a u - Phi b_a) / S)`` with ``K_a = L_aa^-1``.
    """
    weights, u = np.asarray(alpha, dtype=float), np.asarray(u, dtype=float)
    relation = relation_at(body, softenings, triangle, weights, mode)
    if mode == "paper":
        local = body.mesh.surface_local_triangles[triangle]
        energy, root = relation.softened(u)
        alone = body.contact_blocks[local] @ u
        softened = (alone - energy * softenings[local, :3]) / root
        shares = LEAST_SHARE * alone + (1.0 - LEAST_SHARE) * softened
    else:
        shares = np.tile(relation.force(u), (3, 1))
    return body.young_modulus * weights[:, None] * shares


def couplings(compliance: np.ndarray, relations: list[Relation]) -> np.ndarray:
    """How strongly each finger is coupled to all others, (m,).

    ``compliance`` (m, m, 3, 3) is C_pq; ``relations`` are those of the places
    alone. A place with a linear one has coupling 0, for there is nothing to hold.
    """
    count = len(relations)
    total = np.zeros(count)
    stiffness = [np.linalg.inv(compliance[p, p]) for p in range(count)]
    for p, own in enumerate(relations):
        weight = np.outer(own.softening, own.softening)
        weight += SIDEWAYS * own.saturation / own.mean_stiffness * own.stiffness
        alone = float(np.trace(weight @ compliance[p, p]))
        if alone <= 0.0:
            continue
        for q in range(count):
            if q != p:
                back = compliance[p, q] @ stiffness[q] @ compliance[q, p]
                total[p] += np.sqrt(max(float(np.trace(weight @ back)), 0.0) / alone)
    return total


def share_of(coupling: float) -> float:
    """Share (0 to 1) of the correction at a coupling."""
    x = min(max((STRONG - coupling) / (STRONG - WEAK), 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def firmness_of(coupling: float) -> float:
    """Least saturation r at a coupling, in parts of k b.C b."""
    root = float(np.cbrt(min(coupling, STRONG)))
    return root / (1.0 - root)


def coupled(relation: Relation, coupling: float) -> Relation:
    """The relation of a place whose finger is coupled so to others."""
    share = share_of(coupling)
    softening = share * relation.softening
    yielding = float(softening @ np.linalg.solve(relation.stiffness, softening))
    least = relation.mean_stiffness * yielding * firmness_of(coupling)
    return Relation(relation.stiffness, softening, max(share * relation.saturation, least))
