"""The strain energy of a solid and its forces, by component: the numpy of Newton's method."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...law.by_component import Array
from ...law.law import Law
from .strain_term import StrainTerm


@dataclass(frozen=True, eq=False)
class StressedSolid:
    """A solid at some displacements: its strain energy, and what its forces come from.

    Attributes
    ----------
    energy : joule.
    stresses : (3, 3, d) for each term, times volumes.
    """

    energy: float
    stresses: tuple[Array, ...]


@dataclass(frozen=True, eq=False)
class StrainEnergy:
    """The energy of a solid on its nodes, at unit modulus."""

    terms: tuple[StrainTerm, ...]
    law: Law

    def stressed(self, displacements: Array) -> StressedSolid:
        """At displacements (3, f)."""
        there = [term.stressed(displacements, self.law) for term in self.terms]
        energy = sum(float(each.density.sum()) for each in there)
        return StressedSolid(energy, tuple(each.stress for each in there))

    def forces(self, stressed: StressedSolid) -> Array:
        """Forces (3, f) that hold the nodes there: the gradient of the energy."""
        total: Array = np.zeros((3, self.terms[0].gradients.shape[1]))
        for term, stress in zip(self.terms, stressed.stresses, strict=True):
            total += term.by_component.nodal(stress)
        return total
