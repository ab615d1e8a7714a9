"""The opponent of every touch: a sparse solve of the whole body, factored beforehand."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from palpate.core.body.soft_body import SoftBody
from palpate.core.stiffness.assembly import assemble
from palpate.core.stiffness.freedoms import freedoms


def cholespy_module() -> ModuleType | None:
    """CHOLMOD's wheel for Python, if it is installed (``pip install palpate[bench]``)."""
    try:
        return importlib.import_module("cholespy")
    except ImportError:
        return None


class PrefactoredSolve:
    """CHOLMOD's factor of a body's stiffness without the pinned nodes.

    Parameters
    ----------
    body : whose stiffness is factored, at its own modulus.
    cholespy : the module.
    """

    def __init__(self, body: SoftBody, cholespy: ModuleType) -> None:
        stiffness = assemble(
            body.mesh,
            body.poisson_ratio,
            body.young_modulus,
            formulation=body.formulation,
            young_scale=body.young_scale,
        )
        free = np.setdiff1d(np.arange(len(body.mesh.nodes)), body.fixed)
        self._dofs = freedoms(free)
        matrix = stiffness.tocsr()[self._dofs][:, self._dofs].tocsc()
        self._solver = cholespy.CholeskySolverD(
            matrix.shape[0],
            matrix.indptr.astype(np.int32),
            matrix.indices.astype(np.int32),
            matrix.data.astype(np.float64),
            cholespy.MatrixType.CSC,
        )
        self._surface = np.searchsorted(free, body.compliance.free_surface)

    def under(self, forces: NDArray[np.float64]) -> Callable[[], NDArray[np.float64]]:
        """A solve under nodal ``forces`` (N, 3) that returns what the surface does, (n, 3).

        The load is laid out beforehand; only the solve and the selection are in the call.
        """
        load = np.ascontiguousarray(forces.ravel()[self._dofs])
        solution = np.empty_like(load)

        def solve() -> NDArray[np.float64]:
            self._solver.solve(load, solution)
            moved: NDArray[np.float64] = solution.reshape(-1, 3)[self._surface]
            return moved

        return solve
