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
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..solid.free_solid import FreeSolid
from .domain_fields import DomainFields, Field, gram, product, put, symmetric, volume_ratio

ORDER = 3


@dataclass(frozen=True, eq=False)
class SeriesSolid:
    """A body ready for series: its factored stiffness, and its strains for many loads at once.

    Everything at unit modulus; displacements and forces are (f, 3, k): free nodes, axes, loads.
    """

    body: FreeSolid

    @cached_property
    def fields(self) -> tuple[DomainFields, ...]:
        """The terms of the strain energy."""
        return tuple(DomainFields.of(term) for term in self.body.solid.terms)

    def solve(self, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """K^-1 times forces."""
        solved = self.body.factor.solve(forces.reshape(-1, forces.shape[2]))
        return solved.reshape(forces.shape)

    def unit_loads(self, freedoms: NDArray[np.int64]) -> NDArray[np.float64]:
        """1 N on each of these freedoms (k,) of the free surface, ``3 * place + axis``."""
        loads = np.zeros((self.body.node_count, 3, len(freedoms)))
        loads[self.body.surface[freedoms // 3], freedoms % 3, np.arange(len(freedoms))] = 1.0
        return loads

    def terms(self, forces: NDArray[np.float64], order: int = ORDER) -> list[NDArray[np.float64]]:
        """a_1 ... a_order, (f, 3, k) each, for loads f."""
        terms, partial = [self.solve(forces)], [_PartialSeries(field) for field in self.fields]
        while len(terms) < order:
            lower = np.zeros_like(forces)
            for each in partial:
                lower -= each.next_forces(terms[-1])
            terms.append(self.solve(lower))
        return terms

    def second(self, first: NDArray[np.float64]) -> NDArray[np.float64]:
        """a_2 (f, 3, k) of loads whose a_1 is given."""
        lower = np.zeros_like(first)
        for field in self.fields:
            lower -= _PartialSeries(field).next_forces(first)
        return self.solve(lower)

    def forces(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces (f, 3, k) that hold the body at displacements; as :meth:`FreeSolid.forces`."""
        total = np.zeros_like(displacements)
        for field in self.fields:
            stresses = field.no_stress(displacements.shape[2])
            for span, gradient in field.gradients_of(displacements):
                strain = symmetric(gradient) + 0.5 * gram(gradient, gradient)
                stress = field.stress(strain, span)
                put(stresses, span, stress + product(gradient, stress))
            total += field.nodal_forces(stresses)
        return total

    def tangent_forces(
        self, displacements: NDArray[np.float64], change: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """The tangent stiffness at ``displacements`` times ``change``, load by load, (f, 3, k)."""
        total = np.zeros_like(displacements)
        for field in self.fields:
            stresses = field.no_stress(displacements.shape[2])
            both = zip(field.gradients_of(displacements), field.gradients_of(change), strict=True)
            for (span, gradient), (_, turn) in both:
                strain = symmetric(gradient) + 0.5 * gram(gradient, gradient)
                stress = field.stress(strain, span)
                gain = field.stress(symmetric(turn) + gram(gradient, turn), span)
                put(stresses, span, gain + product(gradient, gain) + product(turn, stress))
            total += field.nodal_forces(stresses)
        return total

    def smallest_volume_ratio(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """The smallest det F among the domains, (k,)."""
        ratios = [volume_ratio(part) for _, part in self.fields[0].gradients_of(displacements)]
        smallest: NDArray[np.float64] = np.concatenate(ratios).min(axis=0)
        return smallest


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


def value(terms: Sequence[NDArray[np.float64]], share: NDArray[np.float64]) -> NDArray[np.float64]:
    """The series at shares s (k,) of its loads, terms (..., k) each."""
    total = np.zeros_like(terms[0])
    for term in reversed(terms):
        total = (total + term) * share
    return total
