"""One part of a solid's strain energy: where it is taken, and with which moduli."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ...law.by_component import Array
from ...law.law import Law, Stressed, convex_part
from .gradients import Gradients
from .tangent_pattern import NodePairs

# Domains whose tangents are held at once: some tens of megabytes with what is made of them.
DOMAINS_AT_ONCE = 4096


@dataclass(frozen=True, eq=False)
class StrainTerm:
    """One part of the strain energy, with one deformation gradient for each of its domains.

    Attributes
    ----------
    gradients : csr (3D, N), 1/metre; row ``3 d + J`` takes nodal values to their derivative along
        J, averaged over domain d.
    volumes : (D,), cubic metres.
    first_lame, shear_modulus : (D,), for a body of 1 Pa.
    """

    gradients: csr_array
    volumes: NDArray[np.float64]
    first_lame: NDArray[np.float64]
    shear_modulus: NDArray[np.float64]

    @cached_property
    def by_component(self) -> Gradients:
        """The gradients in the layout of :mod:`palpate.core.law.by_component`."""
        return Gradients.of(self.gradients)

    @cached_property
    def weighted_moduli(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lame's first parameter and shear modulus times volumes, (D,) each."""
        return self.volumes * self.first_lame, self.volumes * self.shear_modulus

    def displacement_gradients(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """H = du/dX in every domain, (D, 3, 3), from displacements (N, 3)."""
        by_axis = self.gradients @ displacements
        return by_axis.reshape(-1, 3, 3).transpose(0, 2, 1)

    def volume_ratios(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """Det F of every domain, (D,); zero or less where it is inverted."""
        gradient = self.displacement_gradients(displacements)
        ratios: NDArray[np.float64] = np.linalg.det(np.eye(3) + gradient)
        return ratios

    def stressed(self, displacements: Array, law: Law) -> Stressed:
        """Energies and stresses times volumes at displacements (3, N)."""
        gradient = self.by_component.of_displacements(displacements)
        return law.stressed(gradient, *self.weighted_moduli)

    def tangent_blocks(
        self, displacements: NDArray[np.float64], law: Law, convex: bool
    ) -> NDArray[np.float64]:
        """Blocks (p, 3, 3) of the tangent stiffness, one for each of :attr:`pairs`.

        Of displacements (N, 3). ``convex`` takes of each domain's tangent its convex part only.
        """
        whole = self.by_component.of_displacements(displacements.T)
        first_lame, shear = self.weighted_moduli
        pairs, count = self.pairs, len(self.volumes)
        blocks = np.empty((len(pairs.domain), 3, 3))
        for begin in range(0, count, DOMAINS_AT_ONCE):
            end = min(begin + DOMAINS_AT_ONCE, count)
            gradient = np.ascontiguousarray(whole[:, :, begin:end])
            found = law.tangent(gradient, first_lame[begin:end], shear[begin:end])
            if convex:
                found = convex_part(found)
            blocks[slice(*np.searchsorted(pairs.domain, (begin, end)))] = _of_pairs(
                found.reshape(-1, 3, 3, 9), pairs, begin, end
            )
        return blocks

    @cached_property
    def pairs(self) -> NodePairs:
        """Every two nodes that share a domain, in ascending order, and each with itself."""
        return NodePairs.of(self.gradients)


def _of_pairs(
    tangents: NDArray[np.float64], pairs: NodePairs, begin: int, end: int
) -> NDArray[np.float64]:
    """Blocks of the pairs in domains from ``begin`` to ``end``, of their (d, 3, 3, 9) tangents."""
    here = slice(*np.searchsorted(pairs.gradient_domain, (begin, end)))
    pair = slice(*np.searchsorted(pairs.domain, (begin, end)))
    gradients = pairs.gradients[here]
    along = gradients[:, None, None, :] @ tangents[pairs.gradient_domain[here] - begin]
    first, second = pairs.first[pair] - here.start, pairs.second[pair] - here.start
    found: NDArray[np.float64] = (
        along.reshape(-1, 3, 3, 3)[first] @ gradients[second][:, None, :, None]
    )
    return found[..., 0]
