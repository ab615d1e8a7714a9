"""From the stiffness matrix to the compliance of the free surface (paper, eq. 4 to 8)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import SuperLU, splu

from .dense_compliance import DenseCompliance
from .errors import PalpateError
from .held_pins import pins_checked
from .progress import Progress, unwatched
from .tet_mesh import TetMesh

# Columns solved in one go: enough to amortise the call, few enough to report and cancel often.
COLUMNS_PER_SOLVE = 96

# A held body solves to about 1e-12; one that can still swing on a hinge does not come near.
LARGEST_RESIDUAL = 1e-6


def surface_compliance(
    mesh: TetMesh,
    stiffness: csr_array,
    fixed: NDArray[np.int64],
    progress: Progress = unwatched,
    dtype: type[np.floating] = np.float32,
) -> DenseCompliance:
    """Invert the stiffness for the free surface nodes (paper, eq. 4, restricted as in its text).

    Parameters
    ----------
    mesh : the body.
    stiffness : (3N, 3N) at E = 1 Pa, from :func:`palpate.core.stiffness.assemble`.
    fixed : numbers of the pinned nodes.
    progress : called with the share done, 0 to 1; may raise to cancel.
    dtype : how the result is stored; the computation is float64.

    Raises
    ------
    PalpateError
        Pins that do not hold the body, or leave nothing to touch.
    """
    fixed = pins_checked(mesh, fixed)
    free_surface = np.setdiff1d(mesh.surface_nodes, fixed)
    free = np.setdiff1d(np.arange(len(mesh.nodes)), fixed)
    free_dofs = (3 * free[:, None] + np.arange(3)).ravel()
    inner_stiffness = stiffness[free_dofs][:, free_dofs].tocsc()
    factor = _factorised(inner_stiffness)
    progress(0.05)
    wanted = (3 * np.searchsorted(free, free_surface)[:, None] + np.arange(3)).ravel()
    count = len(wanted)
    columns = np.empty((count, count), dtype=np.float64)
    for start in range(0, count, COLUMNS_PER_SOLVE):
        part = wanted[start : start + COLUMNS_PER_SOLVE]
        loads = np.zeros((len(free_dofs), len(part)), order="F")
        loads[part, np.arange(len(part))] = 1.0
        displacements = factor.solve(loads)
        if start == 0:
            _refuse_loose_body(inner_stiffness, displacements, loads)
        columns[start : start + len(part)] = displacements[wanted].T
        progress(0.05 + 0.95 * min(1.0, (start + len(part)) / count))
    # K is symmetric, so L is; what the solver leaves of asymmetry is rounding.
    symmetric = 0.5 * (columns + columns.T)
    nodes = len(free_surface)
    return DenseCompliance(free_surface, symmetric.astype(dtype).reshape(nodes, 3, 3 * nodes))


def _factorised(matrix: csc_array) -> SuperLU:
    try:
        return splu(
            matrix,
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as singular:
        raise _loose_body_error() from singular


def _refuse_loose_body(
    matrix: csc_array, solution: NDArray[np.float64], loads: NDArray[np.float64]
) -> None:
    residual = np.abs(matrix @ solution - loads).max()
    if not residual < LARGEST_RESIDUAL:
        raise _loose_body_error()


def _loose_body_error() -> PalpateError:
    return PalpateError(
        "stiffness: the body is not held by its pins (parts that meet only in a node or an edge "
        "can swing); pin each part, or bake with a finer edge length so that they join"
    )
