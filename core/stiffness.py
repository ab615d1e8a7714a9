"""Linear elasticity on four-node tetrahedra: the stiffness matrix K of the paper's equation (1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from .errors import PalpateError
from .tet_mesh import TetMesh


def assemble(mesh: TetMesh, poisson_ratio: float, young_modulus: float = 1.0) -> csr_array:
    """Stiffness matrix of a homogeneous isotropic body (paper, eq. 1).

    Parameters
    ----------
    mesh : tetrahedra, metres.
    poisson_ratio : between -1 and 0.5, both excluded.
    young_modulus : pascal; the method works at 1 Pa and scales at run time.

    Returns
    -------
    csr_array (3N, 3N), newton per metre. Degree of freedom ``3 * node + axis``.

    Raises
    ------
    PalpateError
        A material constant outside its range.
    """
    first_lame, shear_modulus = lame_parameters(young_modulus, poisson_ratio)
    gradients = shape_gradients(mesh)
    volumes = mesh.tet_volumes
    # K_ab = V (lambda g_a g_b^T + mu g_b g_a^T + mu (g_a . g_b) I), for all pairs of corners.
    outer = np.einsum("t,tai,tbj->taibj", volumes, gradients, gradients, optimize=True)
    diagonal = np.einsum("taibi->tab", outer)
    blocks = first_lame * outer + shear_modulus * outer.transpose(0, 1, 4, 3, 2)
    for axis in range(3):
        blocks[:, :, axis, :, axis] += shear_modulus * diagonal
    freedoms = (3 * mesh.tets[:, :, None] + np.arange(3)).reshape(-1, 12)
    rows = np.repeat(freedoms, 12, axis=1).ravel()
    columns = np.tile(freedoms, (1, 12)).ravel()
    size = 3 * len(mesh.nodes)
    return coo_array((blocks.ravel(), (rows, columns)), shape=(size, size)).tocsr()


def lame_parameters(young_modulus: float, poisson_ratio: float) -> tuple[float, float]:
    """Lame's first parameter and the shear modulus, both in pascal.

    Raises
    ------
    PalpateError
        Young's modulus not positive, or Poisson's ratio outside (-1, 0.5).
    """
    if not (np.isfinite(young_modulus) and young_modulus > 0):
        raise PalpateError(
            f"Young's modulus is {young_modulus} Pa, but must be a positive number; "
            "soft props lie between 1e3 and 1e6 Pa"
        )
    if not -1 < poisson_ratio < 0.5:
        raise PalpateError(
            f"Poisson's ratio is {poisson_ratio}, but must lie between -1 and 0.5 (both excluded); "
            "rubber is about 0.49, foam 0.1 to 0.3"
        )
    first_lame = young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))
    return first_lame, young_modulus / (2 * (1 + poisson_ratio))


def shape_gradients(mesh: TetMesh) -> NDArray[np.float64]:
    """Gradients of the four linear shape functions in each tetrahedron, (M, 4, 3), 1/metre."""
    corners = mesh.nodes[mesh.tets]
    edges = corners[:, 1:] - corners[:, :1]
    inner = np.linalg.inv(edges).transpose(0, 2, 1)
    return np.concatenate([-inner.sum(axis=1, keepdims=True), inner], axis=1)
