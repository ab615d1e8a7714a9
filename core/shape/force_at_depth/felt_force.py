r"""The felt force at large depth: the choices, and the relation that ``corrected`` means.

``linear`` is the paper's: the force is K u for a contact point moved by u, however far. A solid of
large deformation softens where it is pressed in. ``corrected`` is the gradient of the energy ::

    Phi(u) = P sqrt((P t)^2 + u.K u) - P^2 t      t = 1 + b.u      P^2 = k / w
           = u.K u / (S + t)                      S = sqrt(t^2 + w u.K u / k)

with the stiffness K of the contact point and its mean k = tr K / 3, the *softening* b (1/m) and the
*saturation* w (1/m^2), to which a small share of the linear relation is added::

    f = c K u + (1 - c) (K u - Phi b) / S          c = LEAST_SHARE

Phi is the length of a vector that depends on u in an affine way, less an affine function, and hence
convex, for all b, all w >= 0 and all u, however far from what b and w were taken from. So the force

* is K u for small u,
* is continuous, with a continuous derivative,
* never falls as u goes on: its derivative is symmetric and at least c K,
* gives back what work it took, on every closed path of u.

Its first terms are ``K u (1 - b.u) - b (u.K u) / 2``: b.u is how much softer the place becomes, w
how soon the force saturates. Both are taken from the solid's power series at the nodes
(:mod:`.softening`) and interpolated by the area coordinates, so that the force is continuous over
edges. Where both are zero the relation is the linear one.

Forces are proportional to Young's modulus; b and w do not depend on it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...body.soft_body import SoftBody
from ...contact.consistent_contact import contact_compliance
from ...contact.equations import ContactMode, Touch
from ...errors import PalpateError

FeltName: TypeAlias = Literal["linear", "corrected"]
FELT_CHOICES: tuple[FeltName, ...] = get_args(FeltName)
EXPLANATIONS: dict[FeltName, str] = {
    "linear": "The paper's: in proportion to the depth, however deep",
    "corrected": "As a solid of large deformation: softer where it is pressed in far",
}

# This share of the linear relation stays at any depth: the force never stops growing.
LEAST_SHARE = 0.05


def felt_name(choice: str) -> FeltName:
    """The name, checked.

    Raises
    ------
    PalpateError
        An unknown one.
    """
    for name in FELT_CHOICES:
        if name == choice:
            return name
    raise PalpateError(
        "felt force {choice} is unknown; give {known}",
        choice=repr(choice),
        known=" or ".join(FELT_CHOICES),
    )


@dataclass(frozen=True, eq=False)
class Relation:
    """Between the displacement of a contact point and the force that moves it so far.

    Attributes
    ----------
    stiffness : K (3, 3), symmetric and positive definite, newton per metre.
    softening : b (3,), 1/metre.
    saturation : w, 1/metre^2, not negative.
    """

    stiffness: NDArray[np.float64]
    softening: NDArray[np.float64]
    saturation: float

    def energy(self, displacement: ArrayLike) -> float:
        """Work to move the contact point by u (3,), joule."""
        u = np.asarray(displacement, dtype=np.float64)
        linear = 0.5 * float(u @ self.stiffness @ u)
        return LEAST_SHARE * linear + (1.0 - LEAST_SHARE) * self.softened(u)[0]

    def force(self, displacement: ArrayLike) -> NDArray[np.float64]:
        """Force (3,) on the body that moves the contact point by u (3,), newton."""
        u = np.asarray(displacement, dtype=np.float64)
        linear = self.stiffness @ u
        force: NDArray[np.float64] = LEAST_SHARE * linear + (
            1.0 - LEAST_SHARE
        ) * self._softened_force(u)
        return force

    def tangent(self, displacement: ArrayLike) -> NDArray[np.float64]:
        """Derivative (3, 3) of :meth:`force`, symmetric and positive definite."""
        u = np.asarray(displacement, dtype=np.float64)
        force, root = self._softened_force(u), self.softened(u)[1]
        both = np.outer(self.softening, force)
        softened = self.stiffness - both - both.T
        softened -= self.saturation / self.mean_stiffness * np.outer(force, force)
        tangent: NDArray[np.float64] = (
            LEAST_SHARE * self.stiffness + (1.0 - LEAST_SHARE) / root * softened
        )
        return tangent

    @property
    def mean_stiffness(self) -> float:
        """Mean stiffness k = tr K / 3, newton per metre."""
        return float(np.trace(self.stiffness)) / 3.0

    def softened(self, u: NDArray[np.float64]) -> tuple[float, float]:
        """Phi and S at a displacement u (3,), joule and a number."""
        twice = float(u @ self.stiffness @ u)
        t = 1.0 + float(self.softening @ u)
        root = float(np.sqrt(t * t + self.saturation * twice / self.mean_stiffness))
        # Each form loses digits where the other one keeps them.
        if t > 0.0:
            return twice / (root + t), root
        return self.mean_stiffness / self.saturation * (root - t), root

    def _softened_force(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        energy, root = self.softened(u)
        force: NDArray[np.float64] = (self.stiffness @ u - energy * self.softening) / root
        return force


def contact_relation(
    body: SoftBody,
    softenings: NDArray[np.float64],
    triangle: int,
    alpha: ArrayLike,
    mode: ContactMode = "consistent",
) -> Relation:
    """The relation of a place on a body of 1 Pa.

    Parameters
    ----------
    softenings : (s, 4), b and w of every node of ``mesh.surface_nodes``; zero where unknown.
    triangle, alpha, mode : as for :meth:`.SoftBody.touch`.
    """
    local = body.mesh.surface_local_triangles[triangle]
    weights = np.asarray(alpha, dtype=np.float64)
    if mode == "paper":
        stiffness = np.einsum("a,aij->ij", weights, body.contact_blocks[local])
    else:
        compliance = contact_compliance(body.surface_blocks(local, local), weights)
        inverse = np.linalg.inv(compliance)
        stiffness = 0.5 * (inverse + inverse.T)
    mixed = weights @ softenings[local]
    return Relation(stiffness, mixed[:3], float(mixed[3]))


def corrected_touch(
    body: SoftBody,
    softenings: NDArray[np.float64],
    triangle: int,
    alpha: ArrayLike,
    displacement: ArrayLike,
    young_modulus: float | None = None,
    mode: ContactMode = "consistent",
) -> Touch:
    """As :meth:`.SoftBody.touch`, with the forces of the corrected relation.

    In mode ``consistent`` the nodes share the force by the area coordinates. In mode ``paper`` each
    bears what is its own: ``a (c K_a u + (1 - c) (K_a u - Phi b_a) / S)`` with ``K_a = L_aa^-1``.
    """
    weights = np.asarray(alpha, dtype=np.float64)
    u = np.asarray(displacement, dtype=np.float64)
    relation = contact_relation(body, softenings, triangle, weights, mode)
    if mode == "paper":
        local = body.mesh.surface_local_triangles[triangle]
        energy, root = relation.softened(u)
        alone = body.contact_blocks[local] @ u
        softened = (alone - energy * softenings[local, :3]) / root
        shares = LEAST_SHARE * alone + (1.0 - LEAST_SHARE) * softened
    else:
        shares = np.tile(relation.force(u), (3, 1))
    modulus = body.modulus(young_modulus)
    corners = body.mesh.surface_triangles[triangle]
    point = weights @ body.mesh.nodes[corners]
    return Touch(corners, weights, point, u, modulus * weights[:, None] * shares)
