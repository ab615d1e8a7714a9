"""St. Venant-Kirchhoff's law: Hooke's between Green's strain and the second stress.

The paper's section 5 has it. It is no material that exists: pressed together by some tenths it
gives way, where rubber stiffens.

References
----------
J. Bonet, R. D. Wood: Nonlinear Continuum Mechanics for Finite Element Analysis, Cambridge
University Press, 2nd edition, 2008, section 6.5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .by_component import (
    Array,
    diagonal,
    identity_added,
    product,
    symmetric_part,
    transposed_product,
)
from .law import Stressed


@dataclass(frozen=True)
class StVenantKirchhoff:
    """W = lambda/2 tr(E)^2 + mu E:E, E = (H + H^T + H^T H) / 2."""

    @property
    def gives_way(self) -> bool:
        """See :class:`.law.Law`."""
        return True

    def stressed(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> Stressed:
        """See :class:`.law.Law`."""
        strain = _green_strain(gradient)
        stress = second_stress(strain, first_lame, shear_modulus)
        density = 0.5 * np.einsum("ijd,ijd->d", stress, strain)
        stress += product(gradient, stress)
        return Stressed(density, stress)

    def tangent(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """See :class:`.law.Law`."""
        stress = second_stress(_green_strain(gradient), first_lame, shear_modulus)
        moved = identity_added(gradient)
        one = np.eye(3)
        found: NDArray[np.float64] = np.einsum("ik,JLd->diJkL", one, stress)
        found += np.einsum("d,iJd,kLd->diJkL", first_lame, moved, moved, optimize=True)
        found += np.einsum("d,iLd,kJd->diJkL", shear_modulus, moved, moved, optimize=True)
        square = np.einsum("iJd,kJd->ikd", moved, moved)
        found += np.einsum("d,JL,ikd->diJkL", shear_modulus, one, square, optimize=True)
        return found.reshape(-1, 9, 9)


def second_stress(
    strain: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
) -> Array:
    """S = lambda tr(E) I + 2 mu E of strains (3, 3, d)."""
    stress: Array = 2.0 * shear_modulus * strain
    on_diagonal = diagonal(stress)
    on_diagonal += first_lame * (strain[0, 0] + strain[1, 1] + strain[2, 2])
    return stress


def _green_strain(gradient: Array) -> Array:
    strain = symmetric_part(gradient)
    strain += 0.5 * transposed_product(gradient, gradient)
    return strain
