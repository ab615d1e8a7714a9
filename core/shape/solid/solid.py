"""The solid: a law of materials on tetrahedra, with the strains of their formulation.

Total Lagrangian: all integrals are taken over the body at rest. Its tangent stiffness at rest is
the K of :func:`palpate.core.stiffness.assembly.assemble`, of the same formulation, by every law.

References
----------
J. Bonet, R. D. Wood: Nonlinear Continuum Mechanics for Finite Element Analysis, Cambridge
University Press, 2nd edition, 2008; the tangent in section 9.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_array, coo_array, csr_array, diags_array

from ...law.law import Law, Stressed
from ...mesh.tet_mesh import TetMesh
from ...stiffness.assembly import lame_parameters, shape_gradients
from ...stiffness.formulation import LINEAR, formulation_checked
from ...stiffness.strain_smoothing import SmoothingDomains, edge_domains, node_domains, tet_domains
from .strain_term import StrainTerm
from .tangent_pattern import TangentPattern


@dataclass(frozen=True, eq=False)
class Solid:
    """A body of 1 Pa whose strains may be large. Stresses and forces scale with Young's modulus.

    Attributes
    ----------
    terms : the strain energy is their sum.
    node_count : N.
    law : of the material.
    """

    terms: tuple[StrainTerm, ...]
    node_count: int
    law: Law

    def energy(self, displacements: NDArray[np.float64]) -> float:
        """Strain energy at displacements (N, 3), joule at unit modulus."""
        return sum(float(there.density.sum()) for there in self._stressed(displacements))

    def forces(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces (N, 3) that hold the body at displacements (N, 3), newton at unit modulus.

        The gradient of :meth:`energy`; in equilibrium they are the forces from outside.
        """
        found = np.zeros((3, self.node_count))
        for term, there in zip(self.terms, self._stressed(displacements), strict=True):
            found += term.by_component.nodal(there.stress)
        return found.T

    def _stressed(self, displacements: NDArray[np.float64]) -> list[Stressed]:
        return [term.stressed(displacements.T, self.law) for term in self.terms]

    def tangent(self, displacements: NDArray[np.float64]) -> csr_array:
        """Tangent stiffness (3N, 3N) at displacements (N, 3), newton per metre at unit modulus.

        The derivative of :meth:`forces`, symmetric. Degree of freedom ``3 * node + axis``.
        """
        blocks, pattern = self.tangent_blocks(displacements), self.pattern
        size = 3 * self.node_count
        starts = np.searchsorted(pattern.rows, np.arange(self.node_count + 1))
        return bsr_array((blocks, pattern.columns, starts), shape=(size, size)).tocsr()

    def tangent_blocks(
        self, displacements: NDArray[np.float64], *, convex: bool = False
    ) -> NDArray[np.float64]:
        """The blocks (m, 3, 3) of :meth:`tangent` at the places of :attr:`pattern`.

        ``convex`` leaves out what would lower the energy at once: the blocks of a positive
        semidefinite matrix, nearest domain by domain.
        """
        parts = [term.tangent_blocks(displacements, self.law, convex) for term in self.terms]
        return self.pattern.summed(np.concatenate(parts))

    @cached_property
    def pattern(self) -> TangentPattern:
        """Pattern of every tangent."""
        rows, columns = (
            np.concatenate([getattr(term.pairs, side) for term in self.terms])
            for side in ("rows", "columns")
        )
        return TangentPattern.of(rows, columns, self.node_count)


def solid(
    mesh: TetMesh,
    poisson_ratio: float,
    law: Law,
    formulation: str = LINEAR,
    young_scale: NDArray[np.float64] | None = None,
) -> Solid:
    """The solid of a body, with the strains of its ``formulation``.

    Parameters
    ----------
    mesh : tetrahedra at rest, metres.
    poisson_ratio : between -1 and 0.5, both excluded.
    law : of the material.
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

    count, each = len(mesh.nodes), (mesh.tets, mesh.tet_volumes, scale)
    if formulation_checked(formulation) == LINEAR:
        whole = tet_domains(mesh.tet_volumes, scale)
        return Solid((term(whole, first_lame, shear_modulus),), count, law)
    if first_lame <= 0:
        return Solid((term(edge_domains(*each), first_lame, shear_modulus),), count, law)
    shear_term = term(edge_domains(*each), 0.0, shear_modulus)
    return Solid((shear_term, term(node_domains(*each), first_lame, 0.0)), count, law)


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
