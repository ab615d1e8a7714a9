"""What a body does when its displacements are quadratic in each tetrahedron, by scikit-fem.

Taylor-Hood elements: quadratic displacements with a continuous linear pressure, which do not lock.
They take some thirty times the work of linear ones, and share no code with the product.
"""

from __future__ import annotations

import numpy as np
import skfem
from numpy.typing import NDArray
from scipy.sparse import block_array, csc_array, csr_array, eye_array, kron, vstack
from scipy.sparse.linalg import SuperLU, splu
from skfem.helpers import ddot, div, dot, sym_grad

from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import lame_parameters

# Below it the pressure would be divided by a first Lame parameter near zero, and nothing locks.
MIXED_FROM = 0.2


class QuadraticReference:
    """The body under tractions on its surface, given as nodal fields and interpolated linearly.

    Parameters
    ----------
    mesh : the body.
    held : int64, nodes that do not move; nor do edges between two of them.
    poisson_ratio : of the material; Young's modulus is 1 Pa times ``young_scale``.
    young_scale : (M,) factors on Young's modulus.
    refinements : how often each tetrahedron is cut into eight first.
    """

    def __init__(
        self,
        mesh: TetMesh,
        held: NDArray[np.int64],
        poisson_ratio: float,
        young_scale: NDArray[np.float64] | None = None,
        refinements: int = 0,
    ) -> None:
        tets = skfem.MeshTet(mesh.nodes.T.copy(), mesh.tets.T.copy(), sort_t=False)
        scale = np.ones(len(mesh.tets)) if young_scale is None else young_scale
        self._to_fine = eye_array(len(mesh.nodes), format="csr")
        for _ in range(refinements):
            self._to_fine = _midpoints(tets.edges, tets.p.shape[1]) @ self._to_fine
            tets, scale = tets.refined(), np.tile(scale, 8)
        assert np.allclose(self._to_fine @ mesh.nodes, tets.p.T)  # noqa: S101  (scikit-fem's order)
        self._node_count = len(mesh.nodes)
        pinned = np.zeros(len(mesh.nodes))
        pinned[held] = 1.0
        self._build(tets, self._to_fine @ pinned > 1 - 1e-9, poisson_ratio, scale)

    def _build(
        self,
        tets: skfem.MeshTet,
        pinned: NDArray[np.bool_],
        poisson_ratio: float,
        scale: NDArray[np.float64],
    ) -> None:
        quadratic = skfem.ElementVector(skfem.ElementTetP2())
        self._basis = skfem.Basis(tets, quadratic, intorder=2)
        nodal, edges = self._basis.nodal_dofs, self._basis.edge_dofs
        still = [nodal[:, pinned], edges[:, pinned[tets.edges].all(axis=0)]]
        self._free = np.setdiff1d(
            np.arange(self._basis.N), np.concatenate([part.ravel() for part in still])
        )
        self.stiffness, self._factor = self._factored(poisson_ratio, scale)
        surface = skfem.FacetBasis(tets, quadratic, intorder=4)
        linear = skfem.FacetBasis(tets, skfem.ElementVector(skfem.ElementTetP1()), intorder=4)
        work = skfem.BilinearForm(lambda u, v, _: dot(u, v))
        order = linear.nodal_dofs.T.ravel()
        self._loads_of = csr_array(work.assemble(linear, surface))[:, order]
        self._linear_loads_of = csr_array(work.assemble(linear))[order][:, order]

    def _factored(
        self, poisson_ratio: float, scale: NDArray[np.float64]
    ) -> tuple[csc_array, SuperLU]:
        first_lame, shear = lame_parameters(1.0, poisson_ratio)
        constant = self._basis.with_element(skfem.ElementTetP0())
        young = constant.interpolate(scale)
        shearing = skfem.BilinearForm(
            lambda u, v, w: 2 * shear * w.young * ddot(sym_grad(u), sym_grad(v))
        ).assemble(self._basis, young=young)
        swelling = skfem.BilinearForm(
            lambda u, v, w: first_lame * w.young * div(u) * div(v)
        ).assemble(self._basis, young=young)
        displacement_only = csc_array(shearing + swelling)[self._free][:, self._free]
        if poisson_ratio < MIXED_FROM:
            return displacement_only, _symmetric_factor(displacement_only)
        pressures = self._basis.with_element(skfem.ElementTetP1())
        coupling = skfem.BilinearForm(lambda u, q, _: div(u) * q).assemble(self._basis, pressures)
        give = skfem.BilinearForm(lambda p, q, w: p * q / (first_lame * w.young)).assemble(
            pressures, young=pressures.with_element(skfem.ElementTetP0()).interpolate(scale)
        )
        coupling = csc_array(coupling)[:, self._free]
        shearing = csc_array(shearing)[self._free][:, self._free]
        mixed = block_array([[shearing, coupling.T], [coupling, -give]], format="csc")
        return displacement_only, _symmetric_factor(mixed)

    @property
    def mass(self) -> csc_array:
        """The mass matrix of the free degrees of freedom at unit density."""
        form = skfem.BilinearForm(lambda u, v, _: dot(u, v))
        return csc_array(form.assemble(self._basis))[self._free][:, self._free]

    def loads(self, tractions: NDArray[np.float64]) -> NDArray[np.float64]:
        """Nodal forces of linear elements under ``tractions`` (k, N, 3), (k, N, 3)."""
        fine = self._on_fine_nodes(tractions)
        back = kron(self._to_fine, np.eye(3), "csr").T @ (self._linear_loads_of @ fine)
        return back.T.reshape(tractions.shape)

    def under(
        self, tractions: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Displacements of the mesh's nodes (k, N, 3) and the work of each load, (k,)."""
        forces = (self._loads_of @ self._on_fine_nodes(tractions))[self._free]
        extended = np.zeros((self._factor.shape[0], forces.shape[1]))
        extended[: len(forces)] = forces
        moved = np.zeros((self._basis.N, forces.shape[1]))
        moved[self._free] = self._factor.solve(extended)[: len(forces)]
        work = np.einsum("fk,fk->k", moved[self._free], forces)
        nodal = self._basis.nodal_dofs[:, : self._node_count]
        return moved[nodal].transpose(2, 1, 0), work

    def _on_fine_nodes(self, tractions: NDArray[np.float64]) -> NDArray[np.float64]:
        flat = tractions.reshape(len(tractions), -1).T
        return np.asarray(kron(self._to_fine, np.eye(3), "csr") @ flat)


def _midpoints(edges: NDArray[np.int64], node_count: int) -> csr_array:
    """Nodes, then middles of edges, from nodes: the order of scikit-fem's refinement."""
    count = edges.shape[1]
    middles = csr_array(
        (np.full(2 * count, 0.5), (np.tile(np.arange(count), 2), edges.ravel())),
        shape=(count, node_count),
    )
    return csr_array(vstack([eye_array(node_count), middles]))


def _symmetric_factor(matrix: csc_array) -> SuperLU:
    """Without pivoting, which quasi-definite matrices do not need."""
    return splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
