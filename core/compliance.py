"""The inverse stiffness of the free surface nodes: L of the paper's equations (4) to (8)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import SuperLU, splu

from .errors import PalpateError
from .progress import Progress, unwatched
from .tet_mesh import TetMesh

# Columns solved in one go: enough to amortise the call, few enough to report and cancel often.
COLUMNS_PER_SOLVE = 96

# A held body solves to about 1e-12; one that can still swing on a hinge does not come near.
LARGEST_RESIDUAL = 1e-6


@dataclass(frozen=True, eq=False)
class Compliance:
    """Displacements of the free surface nodes per newton on each of them, at unit modulus.

    Attributes
    ----------
    free_surface : int64 (n,), node numbers, ascending.
    columns : float32 or float64 (n, 3, 3n). ``columns[j, c].reshape(n, 3)`` holds the
        displacements of all free surface nodes under 1 N on node j along axis c, for E = 1 Pa.
        Divide by Young's modulus for a real material.
    """

    free_surface: NDArray[np.int64]
    columns: NDArray[np.floating]

    @property
    def node_count(self) -> int:
        """Number of free surface nodes, n."""
        return len(self.free_surface)

    def block(self, i: int, j: int) -> NDArray[np.float64]:
        """L_ij, (3, 3): displacement of free surface node i per force on free surface node j."""
        return self.columns[j, :, 3 * i : 3 * i + 3].T.astype(np.float64)

    def diagonal(self) -> NDArray[np.float64]:
        """All blocks L_ii, (n, 3, 3)."""
        seen_by_node = self.columns.reshape(self.node_count, 3, self.node_count, 3)
        own = np.arange(self.node_count)
        return seen_by_node[own, :, own, :].transpose(0, 2, 1).astype(np.float64)

    def apply(self, loaded: NDArray[np.int64], forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacements (n, 3) under ``forces`` (k, 3) on the free surface nodes ``loaded`` (k,).

        Equation (15), for any number of nodes; counts within ``free_surface``, E = 1 Pa.
        """
        touched = self.columns[loaded].reshape(-1, 3 * self.node_count)
        weights = np.asarray(forces, dtype=np.float64).reshape(-1)
        total = np.zeros(3 * self.node_count)
        for weight, column in zip(weights, touched, strict=True):
            total += weight * column
        return total.reshape(-1, 3)


def surface_compliance(
    mesh: TetMesh,
    stiffness: csr_array,
    fixed: NDArray[np.int64],
    progress: Progress = unwatched,
    dtype: type[np.floating] = np.float32,
) -> Compliance:
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
    return Compliance(free_surface, symmetric.astype(dtype).reshape(nodes, 3, 3 * nodes))


def pins_checked(mesh: TetMesh, fixed: NDArray[np.int64]) -> NDArray[np.int64]:
    """The pinned nodes sorted and unique, if they exist and hold every piece of the body.

    Raises
    ------
    PalpateError
        Node numbers out of range; a piece with fewer than three pins, or with all its pins on
        one line, so that it could still move; no free surface node left.
    """
    pins = np.unique(np.asarray(fixed, dtype=np.int64))
    if pins.size and (pins[0] < 0 or pins[-1] >= len(mesh.nodes)):
        raise PalpateError(
            f"pinned nodes: {pins[0] if pins[0] < 0 else pins[-1]} is not a node of this body "
            f"(0 to {len(mesh.nodes) - 1}); pin nodes that exist"
        )
    for piece in range(mesh.component_count):
        held = mesh.nodes[pins[mesh.node_components[pins] == piece]]
        if not _holds(held):
            where = "the body" if mesh.component_count == 1 else f"piece {piece + 1} of the body"
            raise PalpateError(
                f"pins: {where} is pinned at {len(held)} nodes"
                f"{' on one line' if len(held) > 2 else ''} and could move away; pin at least "
                "three nodes that do not lie on a line in each piece"
            )
    if not np.setdiff1d(mesh.surface_nodes, pins).size:
        raise PalpateError(
            "pins: every surface node is pinned, so nothing is left to touch; pin fewer"
        )
    return pins


def _holds(held: NDArray[np.float64]) -> bool:
    """Whether pinned points (k, 3) leave no rotation: at least three, not on one line."""
    if len(held) < 3:
        return False
    spread = np.linalg.svd(held - held.mean(axis=0), compute_uv=False)
    return bool(spread[1] > 1e-9 * spread[0])


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
