"""The St. Venant-Kirchhoff solid: Hooke's law between Green's strain and the second stress.

Total Lagrangian: all integrals are taken over the body at rest. Its tangent stiffness at rest is
the K of :func:`palpate.core.stiffness.assembly.assemble`, of the same formulation.

References
----------
J. Bonet, R. D. Wood: Nonlinear Continuum Mechanics for Finite Element Analysis, Cambridge
University Press, 2nd edition, 2008; the material in section 6.5, the tangent in section 9.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_array, coo_array, csr_array, diags_array

from ...mesh.tet_mesh import TetMesh
from ...stiffness.assembly import lame_parameters, shape_gradients
from ...stiffness.formulation import LINEAR, formulation_checked
from ...stiffness.strain_smoothing import SmoothingDomains, edge_domains, node_domains, tet_domains
from .tangent_pattern import NodePairs, TangentPattern


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

    def displacement_gradients(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """H = du/dX in every domain, (D, 3, 3), from displacements (N, 3)."""
        by_axis = self.gradients @ displacements
        return by_axis.reshape(-1, 3, 3).transpose(0, 2, 1)

    def volume_ratios(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """Det F of every domain, (D,); zero or less where it is inverted."""
        gradient = self.displacement_gradients(displacements)
        ratios: NDArray[np.float64] = np.linalg.det(np.eye(3) + gradient)
        return ratios

    def second_stress(self, strain: NDArray[np.float64]) -> NDArray[np.float64]:
        """S = lambda tr(E) I + 2 mu E for Green's strains E (D, 3, 3), at unit modulus."""
        stress = 2.0 * self.shear_modulus[:, None, None] * strain
        pressure = self.first_lame * np.einsum("dii->d", strain)
        stress[:, (0, 1, 2), (0, 1, 2)] += pressure[:, None]
        return stress

    def nodal_forces(self, first_stress: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces (N, 3) that first Piola-Kirchhoff stresses (D, 3, 3) exert on the nodes."""
        weighted = self.volumes[:, None, None] * first_stress
        forces: NDArray[np.float64] = self.gradients.T @ weighted.transpose(0, 2, 1).reshape(-1, 3)
        return forces

    def tangent_blocks(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """Blocks (p, 3, 3) of the tangent stiffness, one for each of :attr:`pairs`."""
        gradient = self.displacement_gradients(displacements)
        stress = self.second_stress(green_strain(gradient))
        moved = np.eye(3) + gradient
        pairs, volumes = self.pairs, self.volumes[:, None, None]
        at, each = pairs.domain, pairs.gradient_domain
        # F g: how the gradients look from the deformed body.
        forward = np.einsum("qij,qj->qi", moved[each], pairs.gradients)
        pulled = np.einsum("qij,qj->qi", (volumes * stress)[each], pairs.gradients)
        first, second = pairs.first, pairs.second
        own, other = forward[first], forward[second]
        first_lame, shear = (self.volumes * m for m in (self.first_lame, self.shear_modulus))
        metric = shear[:, None, None] * (moved @ moved.transpose(0, 2, 1))
        blocks: NDArray[np.float64] = (first_lame[at, None] * own)[:, :, None] * other[:, None, :]
        blocks += (shear[at, None] * other)[:, :, None] * own[:, None, :]
        near = np.einsum("pi,pi->p", pairs.gradients[first], pairs.gradients[second])
        blocks += near[:, None, None] * metric[at]
        initial = np.einsum("pi,pi->p", pulled[first], pairs.gradients[second])
        for axis in range(3):
            blocks[:, axis, axis] += initial
        return blocks

    @cached_property
    def pairs(self) -> NodePairs:
        """Every two nodes that share a domain, in ascending order, and each with itself."""
        return NodePairs.of(self.gradients)


@dataclass(frozen=True, eq=False)
class Solid:
    """A body of 1 Pa whose strains may be large. Stresses and forces scale with Young's modulus.

    Attributes
    ----------
    terms : the strain energy is their sum.
    node_count : N.
    """

    terms: tuple[StrainTerm, ...]
    node_count: int

    def energy(self, displacements: NDArray[np.float64]) -> float:
        """Strain energy at displacements (N, 3), joule at unit modulus."""
        total = 0.0
        for term in self.terms:
            strain = green_strain(term.displacement_gradients(displacements))
            density = 0.5 * np.einsum("dij,dij->d", term.second_stress(strain), strain)
            total += float(term.volumes @ density)
        return total

    def forces(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces (N, 3) that hold the body at displacements (N, 3), newton at unit modulus.

        The gradient of :meth:`energy`; in equilibrium they are the forces from outside.
        """
        total = np.zeros((self.node_count, 3))
        for term in self.terms:
            gradient = term.displacement_gradients(displacements)
            stress = term.second_stress(green_strain(gradient))
            total += term.nodal_forces(gradient @ stress + stress)
        return total

    def tangent(self, displacements: NDArray[np.float64]) -> csr_array:
        """Tangent stiffness (3N, 3N) at displacements (N, 3), newton per metre at unit modulus.

        The derivative of :meth:`forces`, symmetric. Degree of freedom ``3 * node + axis``.
        """
        blocks, pattern = self.tangent_blocks(displacements), self.pattern
        size = 3 * self.node_count
        starts = np.searchsorted(pattern.rows, np.arange(self.node_count + 1))
        return bsr_array((blocks, pattern.columns, starts), shape=(size, size)).tocsr()

    def tangent_blocks(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """The blocks (m, 3, 3) of :meth:`tangent` at the places of :attr:`pattern`."""
        parts = [term.tangent_blocks(displacements) for term in self.terms]
        return self.pattern.summed(np.concatenate(parts))

    @cached_property
    def pattern(self) -> TangentPattern:
        """Pattern of every tangent."""
        rows, columns = (
            np.concatenate([getattr(term.pairs, side) for term in self.terms])
            for side in ("rows", "columns")
        )
        return TangentPattern.of(rows, columns, self.node_count)

    def volume_ratios(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """Det F of every domain of the first term, (D,); zero or less where it is inverted."""
        return self.terms[0].volume_ratios(displacements)


def solid(
    mesh: TetMesh,
    poisson_ratio: float,
    formulation: str = LINEAR,
    young_scale: NDArray[np.float64] | None = None,
) -> Solid:
    """The solid of a body, with the strains of its ``formulation``.

    Parameters
    ----------
    mesh : tetrahedra at rest, metres.
    poisson_ratio : between -1 and 0.5, both excluded.
    formulation : as in :func:`palpate.core.stiffness.assembly.assemble`.
    young_scale : (M,), factor on Young's modulus for each tetrahedron; None where all are 1.

    Raises
    ------
    PalpateError
        Poisson's ratio outside its range, or an unknown formulation.
    """
    first_lame, shear_modulus = lame_parameters(1.0, poisson_ratio)
    scale = np.ones(len(mesh.tets)) if young_scale is None else young_scale
    gradients = _tet_gradients(mesh)

    def term(domains: SmoothingDomains, first: float, shear: float) -> StrainTerm:
        volumes = domains.volumes
        averaged = _averages(domains) @ gradients
        averaged.sort_indices()
        factor = domains.young_scale
        return StrainTerm(averaged, volumes, first * factor, shear * factor)

    def around(
        group: Callable[
            [NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]], SmoothingDomains
        ],
    ) -> SmoothingDomains:
        return group(mesh.tets, mesh.tet_volumes, scale)

    count = len(mesh.nodes)
    if formulation_checked(formulation) == LINEAR:
        whole = tet_domains(mesh.tet_volumes, scale)
        return Solid((term(whole, first_lame, shear_modulus),), count)
    if first_lame <= 0:
        return Solid((term(around(edge_domains), first_lame, shear_modulus),), count)
    shear_term = term(around(edge_domains), 0.0, shear_modulus)
    return Solid((shear_term, term(around(node_domains), first_lame, 0.0)), count)


def green_strain(gradient: NDArray[np.float64]) -> NDArray[np.float64]:
    """Green's strain E = (H + H^T + H^T H) / 2 of displacement gradients H (..., 3, 3)."""
    turned = gradient.swapaxes(-1, -2)
    strain: NDArray[np.float64] = 0.5 * (gradient + turned + turned @ gradient)
    return strain


def _tet_gradients(mesh: TetMesh) -> csr_array:
    """Derivatives along three axes in each tetrahedron, csr (3M, N)."""
    count = len(mesh.tets)
    rows = (3 * np.arange(count)[:, None, None] + np.arange(3)[:, None]).repeat(4, axis=2)
    columns = np.broadcast_to(mesh.tets[:, None, :], (count, 3, 4))
    values = shape_gradients(mesh).transpose(0, 2, 1)
    shape = (3 * count, len(mesh.nodes))
    return coo_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsr()


def _averages(domains: SmoothingDomains) -> csr_array:
    """Means over domains, for three axes at once, csr (3D, 3M)."""
    shares = (diags_array(1.0 / domains.volumes) @ domains.shares).tobsr((1, 1))
    blocks = shares.data * np.eye(3)
    size = (3 * shares.shape[0], 3 * shares.shape[1])
    return bsr_array((blocks, shares.indices, shares.indptr), shape=size).tocsr()
