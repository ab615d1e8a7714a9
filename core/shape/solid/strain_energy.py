"""The strain energy of a solid and its forces, by component: fast for frames."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...law.by_component import Array
from ...law.law import Law
from .springs import Springs
from .strain_term import StrainTerm


@dataclass(frozen=True, eq=False)
class StressedSolid:
    """A solid at some displacements: its strain energy, and what its forces come from.

    Attributes
    ----------
    energy : joule.
    stresses : (3, 3, d) for each term, times volumes.
    springs : (3, f), newton; None without springs.
    """

    energy: float
    stresses: tuple[Array, ...]
    springs: Array | None = None


@dataclass(frozen=True, eq=False)
class StrainEnergy:
    """The energy of a solid on its nodes, at unit modulus, and of springs if it has any."""

    terms: tuple[StrainTerm, ...]
    law: Law
    springs: Springs | None = None

    def stressed(self, displacements: Array) -> StressedSolid:
        """At displacements (3, f)."""
        there = [term.stressed(displacements, self.law) for term in self.terms]
        energy = sum(float(each.density.sum()) for each in there)
        stresses = tuple(each.stress for each in there)
        if self.springs is None:
            return StressedSolid(energy, stresses)
        pull = self.springs.forces(displacements)
        return StressedSolid(energy + 0.5 * float(np.vdot(pull, displacements)), stresses, pull)

    def forces(self, stressed: StressedSolid) -> Array:
        """Forces (3, f) that hold the nodes there: the gradient of the energy."""
        if stressed.springs is None:
            total = np.zeros((3, self.terms[0].gradients.shape[1]))
        else:
            total = stressed.springs.copy()
        for term, stress in zip(self.terms, stressed.stresses, strict=True):
            total += term.by_component.nodal(stress)
        return total
