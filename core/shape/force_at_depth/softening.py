"""Softening of nodes under a press: b and w of :mod:`.felt_force`, from the solid's power series.

Among all displacements of the body that move a node by u and leave every other free node without
force, the energy is W(u). Its terms of order two to four are those of the linear field a = G u (the
columns of the compliance over the node's own block) in the terms W2, W3, W4 of the energy by the
material's law::

    W(u) = 1/2 u.K u + W3(a) + W4(a) - 1/2 q.(K^-1 - its part that moves the node) q    q = dW3/da

(the theorem of the 2n + 1: an error of first order in the field is one of second order in the
energy). So a node takes its three columns of K^-1, one evaluation of q, and one more solve.

The relation is to agree with it along the inward normal n: in energy and force to the third order,
in energy also to the fourth::

    dW3/du (n) = -(1-c) (K n (b.n) + b (n.K n) / 2)
    W4_total(n) = (1-c) ((n.K n) (b.n)^2 / 2 - w (n.K n)^2 / (8 k))

w is not let below ``k b.C b / 4`` (C = K^-1), also where the solid saturates later: pulled out, or
pressed in where b.n is negative, the relation becomes stiffer, and so its tangent stays below 11.2
times that at rest.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...law.by_component import symmetric_part
from ...law.st_venant_kirchhoff import second_stress
from ..solid.free_solid import FreeSolid
from ..solid.solid import Solid
from .felt_force import LEAST_SHARE

# Nodes at a time: their fields are held at once, some megabytes each on a body of 10,000 tets.
NODES_AT_ONCE = 4

# The largest displacement gradient at which a law is asked for the terms of its stress: their
# differences lose as many digits to rounding as to the terms beyond.
LARGEST_GRADIENT = 1e-3

# Of k b.C b, the least saturation. Tangents are at most ((1 + this) / this)^1.5 times that at rest.
LEAST_SATURATION = 0.25


def node_softening(
    solid: FreeSolid, places: NDArray[np.int64], inward: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Softening b and saturation w of nodes, (k, 4), 1/metre and 1/metre^2.

    Parameters
    ----------
    solid : the body.
    places : (k,), of the nodes among ``solid.free``.
    inward : unit normals (k, 3) that point into the body.
    """
    found = [
        _of_few(solid, places[first : first + NODES_AT_ONCE], inward[first : first + NODES_AT_ONCE])
        for first in range(0, len(places), NODES_AT_ONCE)
    ]
    return np.concatenate(found) if found else np.zeros((0, 4))


def _of_few(
    solid: FreeSolid, places: NDArray[np.int64], inward: NDArray[np.float64]
) -> NDArray[np.float64]:
    count, size = len(places), 3 * solid.node_count
    unit = np.zeros((size, 3 * count))
    own = (3 * places[:, None] + np.arange(3)).reshape(-1)
    unit[own, np.arange(3 * count)] = 1.0
    columns = solid.factor.solve(unit).reshape(size, count, 3)
    each = np.arange(count)
    compliance = columns[own.reshape(count, 3), each[:, None]]
    compliance = 0.5 * (compliance + compliance.transpose(0, 2, 1))
    stiffness = np.linalg.inv(compliance)
    pressed = np.einsum("pij,pj->pi", stiffness, inward)
    fields = np.einsum("xpi,pi->px", columns, pressed).reshape(count, -1, 3)
    quartic = np.empty(count)
    forces = np.empty((count, size))
    for k, field in enumerate(fields):
        quartic[k], forces[k] = _higher_terms(solid.solid, field)
    moved = solid.factor.solve(forces.T)
    # What q does at the node itself, and what it would cost to leave that in place.
    cubic_slope = np.einsum("px,xpj,pji->pi", forces, columns, stiffness)
    back = moved[own.reshape(count, 3), each[:, None]]
    quartic -= 0.5 * np.einsum("px,xp->p", forces, moved)
    quartic += 0.5 * np.einsum("pi,pij,pj->p", back, stiffness, back)
    return _fitted(compliance, stiffness, inward, cubic_slope, quartic)


def _fitted(
    compliance: NDArray[np.float64],
    stiffness: NDArray[np.float64],
    inward: NDArray[np.float64],
    cubic_slope: NDArray[np.float64],
    quartic: NDArray[np.float64],
) -> NDArray[np.float64]:
    softened = 1.0 - LEAST_SHARE
    pressed = np.einsum("pij,pj->pi", stiffness, inward)
    firm = np.einsum("pi,pi->p", pressed, inward)
    mean = np.einsum("pii->p", stiffness) / 3.0
    along = -2.0 / 3.0 * np.einsum("pi,pi->p", cubic_slope, inward) / (softened * firm)
    b = -2.0 * (cubic_slope / softened + along[:, None] * pressed) / firm[:, None]
    w = 8.0 * mean * (0.5 * along**2 / firm - quartic / (softened * firm**2))
    least = LEAST_SATURATION * mean * np.einsum("pi,pij,pj->p", b, compliance, b)
    return np.column_stack([b, np.maximum(w, least)])


def _higher_terms(solid: Solid, field: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
    """W4 of a field (f, 3), and q = dW3/da (3f,)."""
    quartic, forces = 0.0, np.zeros(field.T.shape)
    for term in solid.terms:
        gradient = term.by_component.of_displacements(field.T)
        step = LARGEST_GRADIENT / float(np.abs(gradient).max())
        # P(t H) = t P1 + t^2 P2 + t^3 P3 + ...: the derivatives of W2, W3 and W4 at H.
        ahead, behind = (
            solid.law.stressed(sign * step * gradient, *term.weighted_moduli).stress
            for sign in (1.0, -1.0)
        )
        first = second_stress(symmetric_part(gradient), *term.weighted_moduli)
        third = (0.5 * (ahead - behind) / step - first) / step**2
        quartic += 0.25 * float(np.einsum("ijd,ijd->", third, gradient))
        forces += term.by_component.nodal(0.5 * (ahead + behind) / step**2)
    return quartic, forces.T.ravel()
