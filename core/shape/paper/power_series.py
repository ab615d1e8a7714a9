"""Displacements as a power series in the force, u(s) = a_1 s + a_2 s^2 + ..., for loads s f.

The internal force of a St. Venant-Kirchhoff solid is a cubic polynomial of the displacements, so
every order costs one solve with the stiffness at rest: K a_1 = f, and K a_k = -(what the lower
orders leave in order k). One factor serves all orders, all loads and both signs of each.

References
----------
B. Cochelin: A path-following technique via an asymptotic-numerical method, Computers & Structures
53 (1994), 1181-1192.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..solid.free_solid import FreeSolid
from .domain_fields import DomainFields, Field, gram, product, put, symmetric


def series_terms(
    body: FreeSolid, fields: Sequence[DomainFields], forces: NDArray[np.float64], order: int
) -> list[NDArray[np.float64]]:
    """a_1 ... a_order, (f, 3, k) each, of loads (f, 3, k) on the free nodes, at unit modulus.

    ``fields`` are those of the body's terms of strain energy, :meth:`DomainFields.of`.
    """
    terms, partial = [_solved(body, forces)], [_PartialSeries(field) for field in fields]
    while len(terms) < order:
        lower = np.zeros_like(forces)
        for each in partial:
            lower -= each.next_forces(terms[-1])
        terms.append(_solved(body, lower))
    return terms


def _solved(body: FreeSolid, forces: NDArray[np.float64]) -> NDArray[np.float64]:
    return body.factor.solve(forces.reshape(-1, forces.shape[2])).reshape(forces.shape)


class _PartialSeries:
    """The orders of gradient and stress in the domains of one term, as far as they are known."""

    def __init__(self, fields: DomainFields) -> None:
        self._fields = fields
        self._gradients: dict[int, list[Field]] = {}
        self._stresses: dict[int, list[Field]] = {}
        self._known: dict[int, Field] = {}

    def next_forces(self, newest: NDArray[np.float64]) -> NDArray[np.float64]:
        """What a_1 ... a_k, of which a_k is handed in, leave in order k + 1, (f, 3, loads)."""
        first_stress = self._fields.no_stress(newest.shape[2])
        for span, gradient in self._fields.gradients_of(newest):
            put(first_stress, span, self._first_stress(span, gradient))
        return self._fields.nodal_forces(first_stress)

    def _first_stress(self, span: slice, gradient: Field) -> Field:
        stress = self._fields.stress(symmetric(gradient), span)
        if span.start in self._known:
            stress += self._known[span.start]
        gradients = self._gradients.setdefault(span.start, [])
        stresses = self._stresses.setdefault(span.start, [])
        gradients.append(gradient)
        stresses.append(stress)
        # E and P of order k + 1, but for what is linear in a_(k + 1).
        known = self._fields.stress(_square(gradients), span)
        self._known[span.start] = known
        first_stress: Field = known.copy()
        for one, of_rest in zip(gradients, reversed(stresses), strict=True):
            first_stress += product(one, of_rest)
        return first_stress


def _square(gradients: Sequence[Field]) -> Field:
    """The order k + 1 of H^T H / 2, given the orders 1 to k of H."""
    total = np.zeros_like(gradients[0])
    count = len(gradients)
    for place in range(count // 2):
        total += gram(gradients[place], gradients[count - 1 - place])
    if count % 2:
        total += 0.5 * gram(gradients[count // 2], gradients[count // 2])
    return total
