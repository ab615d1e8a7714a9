"""What a law of a material answers, and the part of a tangent that never turns a step uphill.

A law is asked at places of a body, each with its displacement gradient H = du/dX, so that nothing
is lost to rounding where H is small. Its energy is a sum of two parts, one that grows with Lame's
first parameter and one with the shear modulus: smoothed tetrahedra have them at different places
(:mod:`..stiffness.strain_smoothing`). To second order in H the energy is that of linear elasticity.

Moduli are those of the place, so that a law itself has no unit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .by_component import Array


@dataclass(frozen=True, eq=False)
class Stressed:
    """Energy density (d,) and first Piola-Kirchhoff stress (3, 3, d) of places, pascal."""

    density: NDArray[np.float64]
    stress: Array


class Law(Protocol):
    """Isotropic law of a material.

    Arguments of both: ``gradient`` H (3, 3, d), ``first_lame`` and ``shear_modulus`` (d,), pascal.
    """

    @property
    def gives_way(self) -> bool:
        """Whether what is pressed together resists less and less from some strain on."""
        ...

    def stressed(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> Stressed:
        """Energy density and stress, its derivative by H."""
        ...

    def tangent(
        self, gradient: Array, first_lame: NDArray[np.float64], shear_modulus: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Derivative of the stress by H, (d, 9, 9), symmetric; row ``3 i + J`` is P_iJ's."""
        ...


def convex_part(tangents: NDArray[np.float64]) -> NDArray[np.float64]:
    """Nearest positive semidefinite matrices of symmetric ones (d, 9, 9).

    A step of Newton's method with them goes downhill wherever the energy has a slope.
    """
    values, vectors = np.linalg.eigh(tangents)
    kept = np.maximum(values, 0.0)
    projected: NDArray[np.float64] = (vectors * kept[:, None, :]) @ vectors.transpose(0, 2, 1)
    return projected
