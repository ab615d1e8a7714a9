"""Displacements as a power series in the force, u(s) = u_0 + a_1 s + a_2 s^2 + ..., for loads s f.

The internal force of a St. Venant-Kirchhoff solid is a cubic polynomial of the displacements, so
every order costs one solve with the tangent stiffness at u_0, the state at rest or an equilibrium:
K a_1 = f, and K a_k = -(what the lower orders leave in order k). One factor serves all orders and
both signs, at rest all loads.

References
----------
B. Cochelin: A path-following technique via an asymptotic-numerical method, Computers & Structures
53 (1994), 1181-1192.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...compliance.elimination.cholesky import CholeskyFactor
from ...law.by_component import Array, product, symmetric_part, transposed_product
from ...law.st_venant_kirchhoff import second_stress
from ..solid.free_solid import FreeSolid
from ..solid.strain_term import StrainTerm


@dataclass(frozen=True, eq=False)
class SeriesStart:
    """Start of power series.

    Attributes
    ----------
    terms : of the body's strain energy.
    factor : of the tangent stiffness there.
    displacements : (f, 3), u_0; None at rest.
    """

    terms: Sequence[StrainTerm]
    factor: CholeskyFactor
    displacements: NDArray[np.float64] | None = None

    @classmethod
    def at_rest(cls, body: FreeSolid) -> SeriesStart:
        """The body without loads.

        Raises
        ------
        PalpateError
            The pins do not hold it.
        """
        return cls(body.solid.terms, body.factor)

    def moved(self, body: FreeSolid, displacements: NDArray[np.float64]) -> SeriesStart:
        """The same body in an equilibrium at displacements (f, 3).

        Raises
        ------
        NotPositiveDefiniteError
            It is not stable.
        """
        factor = body.elimination.factor(body.solid.tangent_blocks(displacements))
        return SeriesStart(self.terms, factor, displacements)

    def series(self, force: NDArray[np.float64], order: int) -> list[NDArray[np.float64]]:
        """a_1 ... a_order, (f, 3) each, of a load (f, 3) that is added, at unit modulus."""
        found = [self._solved(force)]
        partial = [_PartialSeries(term, self.displacements) for term in self.terms]
        while len(found) < order:
            left = np.zeros_like(force)
            for each in partial:
                left += each.next_forces(found[-1])
            found.append(self._solved(-left))
        return found

    def _solved(self, force: NDArray[np.float64]) -> NDArray[np.float64]:
        return self.factor.solve(force.ravel()).reshape(force.shape)


class _PartialSeries:
    """The orders of gradient and stress in the domains of one term, as far as they are known."""

    def __init__(self, term: StrainTerm, start: NDArray[np.float64] | None) -> None:
        self._term = term
        self._start = None if start is None else term.by_component.of_displacements(start.T)
        self._gradients: list[Array] = []
        self._stresses: list[Array] = []
        self._known: Array | None = None

    def next_forces(self, newest: NDArray[np.float64]) -> NDArray[np.float64]:
        """Residual of a_1 ... a_k, of which a_k is given, in order k + 1, (f, 3)."""
        gradient = self._term.by_component.of_displacements(newest.T)
        strain = gradient
        if self._start is not None:
            strain = gradient + transposed_product(self._start, gradient)
        stress = second_stress(symmetric_part(strain), *self._term.weighted_moduli)
        if self._known is not None:
            stress += self._known
        self._gradients.append(gradient)
        self._stresses.append(stress)
        # E and P of order k + 1, but for what is linear in a_(k + 1).
        self._known = second_stress(_square(self._gradients), *self._term.weighted_moduli)
        first_stress = self._known.copy()
        if self._start is not None:
            first_stress += product(self._start, self._known)
        for one, of_rest in zip(self._gradients, reversed(self._stresses), strict=True):
            first_stress += product(one, of_rest)
        return self._term.by_component.nodal(first_stress).T


def _square(gradients: Sequence[Array]) -> Array:
    """The order k + 1 of H^T H / 2, given the orders 1 to k of H."""
    total, count = np.zeros_like(gradients[0]), len(gradients)
    for place in range(count // 2):
        total += transposed_product(gradients[place], gradients[count - 1 - place])
    if count % 2:
        total += 0.5 * transposed_product(gradients[count // 2], gradients[count // 2])
    return symmetric_part(total)
