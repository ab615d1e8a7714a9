"""The corrected force of several fingers: each softens its own place, and they feel each other.

Own parts v of the displacements and forces F are sought with ::

    v_p + sum_q C_pq F_q = u_p    (q the others)        F_p = the force of p's own relation at v_p

What a finger does to the others' places stays linear. In forces this is the least of a sum of
energies, 1/2 F.C F with each block C_pp replaced by the complementary energy of p's relation. Where
places soften that is convex: each F is unique, and while no finger slides on its cone the forces
are the gradient of an energy of the displacements. One finger alone has exactly its relation.

Where fingers hold each other, as in a pinch of a slender part, the own parts are many times as long
as the displacements. Their relations are therefore nearer to linear the more strongly the places
are coupled: :mod:`.felt_coupling`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...body.soft_body import SoftBody
from ...contact.equations import ContactMode, Touch
from ...contact.several_contacts import push_cones, solve_with_cones, told_apart
from ...errors import PalpateError
from .felt_coupling import coupled, couplings
from .felt_force import Relation, contact_relation, corrected_touch

# Newton's rounds; five are enough as a rule. Displacements are taken as found when they change by
# this share of the largest one.
MOST_ROUNDS = 50
CONVERGED = 1e-13


def corrected_touches(
    body: SoftBody,
    softenings: NDArray[np.float64],
    touches: Sequence[Touch],
    young_modulus: float | None = None,
    mode: ContactMode = "consistent",
) -> tuple[Touch, ...]:
    """The touches of :meth:`.SoftBody.touch_several` with the forces of the corrected relation.

    In mode ``paper`` every finger is answered as if it were alone.

    Raises
    ------
    PalpateError
        The forces are not found: displacements that are too large.
    """
    modulus = body.modulus(young_modulus)
    triangles = [_triangle_of(body, touch) for touch in touches]
    if mode == "paper" or len(touches) == 1:
        return tuple(
            corrected_touch(
                body, softenings, triangle, touch.alpha, touch.displacement, modulus, mode
            )
            for triangle, touch in zip(triangles, touches, strict=True)
        )
    alphas = np.array([touch.alpha for touch in touches])
    relations = [
        contact_relation(body, softenings, triangle, alpha)
        for triangle, alpha in zip(triangles, alphas, strict=True)
    ]
    pushes = np.array([touch.displacement for touch in touches])
    resting = ~pushes.any(axis=1)
    pushes[resting] = -np.array([_outward(touch, body) for touch in touches])[resting]
    compliance = told_apart(body.contact_compliance(triangles, alphas))
    asked = np.array([touch.displacement for touch in touches])
    relations = [
        coupled(one, float(coupling))
        for one, coupling in zip(relations, couplings(compliance, relations), strict=True)
    ]
    forces = modulus * solve_softened(compliance, relations, asked, pushes)
    return tuple(
        Touch(
            touch.triangle,
            touch.alpha,
            touch.point,
            touch.displacement,
            touch.alpha[:, None] * force,
        )
        for touch, force in zip(touches, forces, strict=True)
    )


def solve_softened(
    compliance: NDArray[np.float64],
    relations: Sequence[Relation],
    displacements: ArrayLike,
    pushes: ArrayLike,
) -> NDArray[np.float64]:
    """Forces (m, 3) on a body of 1 Pa of fingers that may only push.

    Parameters
    ----------
    compliance : (m, m, 3, 3), :func:`.told_apart`.
    relations : of each finger's place.
    displacements, pushes : (m, 3), as for :func:`.several_contacts.solve_contacts`.

    Raises
    ------
    PalpateError
        The forces are not found; see :func:`corrected_touches`.
    """
    asked = np.asarray(displacements, dtype=np.float64)
    each = np.arange(len(asked))
    cones = push_cones(compliance, np.asarray(pushes, dtype=np.float64))
    own = np.zeros_like(asked)
    series, forces = compliance.copy(), None
    for _ in range(MOST_ROUNDS):
        felt = np.array([one.force(v) for one, v in zip(relations, own, strict=True)])
        tangents = [one.tangent(v) for one, v in zip(relations, own, strict=True)]
        series[each, each] = np.linalg.inv(tangents)
        shifted = asked - own + np.einsum("pij,pj->pi", series[each, each], felt)
        forces = solve_with_cones(series, shifted, *cones, forces)
        change = np.einsum("pij,pj->pi", series[each, each], forces - felt)
        own = own + change
        if np.abs(change).max() <= CONVERGED * np.abs(own).max():
            return forces
    raise PalpateError(
        "felt force: the corrected forces of these fingers are not found, for they go too far; "
        "press less or choose the linear one"
    )


def _triangle_of(body: SoftBody, touch: Touch) -> int:
    return int(np.flatnonzero((body.mesh.surface_triangles == touch.triangle).all(axis=1))[0])


def _outward(touch: Touch, body: SoftBody) -> NDArray[np.float64]:
    i, j, k = body.mesh.nodes[touch.triangle]
    normal = np.cross(j - i, k - i)
    unit: NDArray[np.float64] = normal / np.linalg.norm(normal)
    return unit
