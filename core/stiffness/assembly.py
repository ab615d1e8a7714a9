"""Linear elasticity on four-node tetrahedra: the stiffness matrix K of the paper's equation (1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import bsr_array, csr_array

from ..errors import PalpateError
from ..mesh.tet_mesh import TetMesh, young_scale_checked
from .formulation import LINEAR, formulation_checked
from .strain_smoothing import (
    SmoothingDomains,
    edge_domains,
    gradient_products,
    node_domains,
    tet_domains,
)


def assemble(
    mesh: TetMesh,
    poisson_ratio: float,
    young_modulus: float = 1.0,
    *,
    formulation: str = LINEAR,
    young_scale: ArrayLike | None = None,
) -> csr_array:
    """Stiffness matrix of an isotropic body (paper, eq. 1).

    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> mesh, fixed = paper_cube()
    >>> stiffness = assemble(mesh, poisson_ratio=0.45)
    >>> stiffness.shape, bool(np.allclose(stiffness @ np.ones(375), 0.0))  # moved, not deformed
    ((375, 375), True)

    Parameters
    ----------
    mesh : tetrahedra, metres.
    poisson_ratio : between -1 and 0.5, both excluded.
    young_modulus : pascal; the method works at 1 Pa and scales at run time.
    formulation : ``"linear"``, the paper's, with the strain constant in each tetrahedron; or
        ``"smoothed"``, which does not lock as Poisson's ratio approaches 0.5.
    young_scale : (M,), a positive factor on Young's modulus for each tetrahedron.

    Returns
    -------
    csr_array (3N, 3N), newton per metre. Degree of freedom ``3 * node + axis``.

    Raises
    ------
    PalpateError
        A material constant outside its range, or an unknown formulation.
    """
    first_lame, shear_modulus = lame_parameters(young_modulus, poisson_ratio)
    scale = (
        np.ones(len(mesh.tets))
        if young_scale is None
        else young_scale_checked(young_scale, len(mesh.tets))
    )
    if formulation_checked(formulation) == LINEAR:
        products = _products(mesh, tet_domains(mesh.tet_volumes, scale))
        stiffness = isotropic(products, first_lame, shear_modulus)
    else:
        stiffness = _smoothed(mesh, first_lame, shear_modulus, scale)
    matrix = stiffness.tocsr()
    matrix.sort_indices()
    return matrix


def _smoothed(
    mesh: TetMesh, first_lame: float, shear_modulus: float, young_scale: NDArray[np.float64]
) -> bsr_array:
    """Stiffness with shear averaged around edges, volume around nodes: selective ES/NS-FEM."""
    by_edges = _products(mesh, edge_domains(mesh.tets, mesh.tet_volumes, young_scale))
    if first_lame <= 0:
        # Cork and auxetic foam: a negative volume term must be averaged over the same domains as
        # the positive ones that outweigh it.
        return isotropic(by_edges, first_lame, shear_modulus)
    by_nodes = _products(mesh, node_domains(mesh.tets, mesh.tet_volumes, young_scale))
    sum_of_both: bsr_array = isotropic(by_edges, 0.0, shear_modulus) + first_lame * by_nodes
    return sum_of_both


def _products(mesh: TetMesh, domains: SmoothingDomains) -> bsr_array:
    return gradient_products(domains, mesh.tets, shape_gradients(mesh))


def isotropic(products: bsr_array, first_lame: float, shear_modulus: float) -> bsr_array:
    """Stiffness blocks lambda P_ab + mu P_ab^T + mu tr(P_ab) I from gradient products P_ab, N/m."""
    trace = np.einsum("bii->b", products.data)
    blocks = first_lame * products.data + shear_modulus * products.data.transpose(0, 2, 1)
    for axis in range(3):
        blocks[:, axis, axis] += shear_modulus * trace
    return bsr_array((blocks, products.indices, products.indptr), shape=products.shape)


def lame_parameters(young_modulus: float, poisson_ratio: float) -> tuple[float, float]:
    """Lame's first parameter and the shear modulus, both in pascal.

    Raises
    ------
    PalpateError
        Young's modulus not positive, or Poisson's ratio outside (-1, 0.5).
    """
    if not (np.isfinite(young_modulus) and young_modulus > 0):
        raise PalpateError(
            "Young's modulus is {young_modulus} Pa, but must be a positive number; soft props lie "
            "between 1e3 and 1e6 Pa",
            young_modulus=young_modulus,
        )
    if not -1 < poisson_ratio < 0.5:
        raise PalpateError(
            "Poisson's ratio is {poisson_ratio}, but must lie between -1 and 0.5 (both excluded); "
            "rubber is about 0.49, foam 0.1 to 0.3",
            poisson_ratio=poisson_ratio,
        )
    first_lame = young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))
    return first_lame, young_modulus / (2 * (1 + poisson_ratio))


def shape_gradients(mesh: TetMesh) -> NDArray[np.float64]:
    """Gradients of the four linear shape functions in each tetrahedron, (M, 4, 3), 1/metre."""
    corners = mesh.nodes[mesh.tets]
    edges = corners[:, 1:] - corners[:, :1]
    inner = np.linalg.inv(edges).transpose(0, 2, 1)
    return np.concatenate([-inner.sum(axis=1, keepdims=True), inner], axis=1)
