"""The strain energy of a :class:`.solid.Solid` and its forces, by component: fast for frames.

The St. Venant-Kirchhoff solid collapses under strong compression and then turns inside out, which
a press on a single node brings about early. What is drawn should not, so a domain that has lost
more than 60 % of its volume is held by k/2 (J0 - J)^2, J its det F. Above J0 nothing differs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .by_component import (
    Array,
    cofactors,
    determinants,
    diagonal,
    identity_added,
    product,
    symmetric_part,
    transposed_product,
)
from .gradients import Gradients
from .solid import StrainTerm
from .springs import Springs

# J0, and k over the shear modulus.
RESISTS_BELOW = 0.4
RESISTANCE = 20.0


@dataclass(frozen=True, eq=False)
class StressedTerm:
    """One term's energy, joule, and its first stresses times volumes, (3, 3, d)."""

    energy: float
    stresses: Array


@dataclass(frozen=True, eq=False)
class EnergyTerm:
    """Energy term as :class:`.solid.StrainTerm`, held below J0; moduli times volumes, (d,)."""

    gradients: Gradients
    first_lame: NDArray[np.float64]
    shear_modulus: NDArray[np.float64]

    @classmethod
    def of(cls, term: StrainTerm, gradients: Gradients) -> EnergyTerm:
        """With the term's gradients by component, which may be shared."""
        volumes = term.volumes
        return cls(gradients, volumes * term.first_lame, volumes * term.shear_modulus)

    def stressed(self, displacements: Array) -> StressedTerm:
        """At displacements (3, f)."""
        gradient = self.gradients.of_displacements(displacements)
        strain = symmetric_part(gradient)
        strain += 0.5 * transposed_product(gradient, gradient)
        stress = self.second_stress(strain)
        energy = 0.5 * float(np.einsum("ijd,ijd->", stress, strain))
        stress += product(gradient, stress)
        return StressedTerm(energy + self._resist_collapse(gradient, stress), stress)

    def second_stress(self, strain: Array) -> Array:
        """S = lambda tr(E) I + 2 mu E of strains (3, 3, d), times the volumes; nothing is held."""
        stress: Array = 2.0 * self.shear_modulus * strain
        on_diagonal = diagonal(stress)
        on_diagonal += self.first_lame * (strain[0, 0] + strain[1, 1] + strain[2, 2])
        return stress

    def _resist_collapse(self, gradient: Array, stress: Array) -> float:
        """Add the stress of what keeps a domain from collapsing; returns its energy."""
        deformed = identity_added(gradient)
        lacking = RESISTS_BELOW - determinants(deformed)
        (near,) = np.nonzero(lacking > 0.0)
        if not near.size:
            return 0.0
        stiffness = RESISTANCE * self.shear_modulus[near]
        pressure = stiffness * lacking[near]
        stress[:, :, near] -= pressure * cofactors(deformed[:, :, near])
        return 0.5 * float(pressure @ lacking[near])


@dataclass(frozen=True, eq=False)
class Stressed:
    """A solid at some displacements: its strain energy, joule, and what its forces come from.

    Attributes
    ----------
    energy : joule.
    terms : the stresses.
    springs : (3, f), newton; None without springs.
    """

    energy: float
    terms: tuple[StressedTerm, ...]
    springs: Array | None = None


@dataclass(frozen=True, eq=False)
class StrainEnergy:
    """The energy of a solid on its free nodes, at unit modulus, and of springs if it has any."""

    terms: tuple[EnergyTerm, ...]
    springs: Springs | None = None

    def stressed(self, displacements: Array) -> Stressed:
        """At displacements (3, f)."""
        terms = tuple(term.stressed(displacements) for term in self.terms)
        energy = sum(term.energy for term in terms)
        if self.springs is None:
            return Stressed(energy, terms)
        pull = self.springs.forces(displacements)
        return Stressed(energy + 0.5 * float(np.vdot(pull, displacements)), terms, pull)

    def forces(self, stressed: Stressed) -> Array:
        """Forces (3, f) that hold the nodes there: the gradient of the energy."""
        if stressed.springs is None:
            total = np.zeros((3, self.terms[0].gradients.backward.shape[0]))
        else:
            total = stressed.springs.copy()
        for term, there in zip(self.terms, stressed.terms, strict=True):
            total += term.gradients.nodal(there.stresses)
        return total
