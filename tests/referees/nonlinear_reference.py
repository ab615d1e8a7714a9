"""Large deformations by scikit-fem: its own assembly, Newton's method in even load steps.

Nothing is shared with Palpate but the tetrahedra: the weak forms of a law in total Lagrangian
description are integrated by scikit-fem, and solved with scipy's sparse LU.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTetP1, ElementVector, LinearForm, MeshTet
from skfem.helpers import ddot, det, eye, grad, inv, mul, trace, transpose
from skfem.models.elasticity import lame_parameters

from palpate.core.mesh.tet_mesh import TetMesh

CONVERGED = 1e-10
MOST_ITERATIONS = 25


def _stress(
    gradient: NDArray[np.float64], first: float, shear: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The deformation gradient and the second Piola-Kirchhoff stress."""
    moved = gradient + eye(1.0 + 0.0 * gradient[0, 0], 3)
    strain = 0.5 * (mul(transpose(moved), moved) - eye(1.0 + 0.0 * gradient[0, 0], 3))
    return moved, first * eye(trace(strain), 3) + 2.0 * shear * strain


@BilinearForm
def _tangent(u: Any, v: Any, w: Any) -> Any:
    moved, stress = _stress(grad(w["displacement"]), w["first"], w["shear"])
    change = mul(transpose(moved), grad(u))
    change = 0.5 * (change + transpose(change))
    tested = mul(transpose(moved), grad(v))
    changed = w["first"] * eye(trace(change), 3) + 2.0 * w["shear"] * change
    return ddot(changed, tested) + ddot(stress, mul(transpose(grad(u)), grad(v)))


@LinearForm
def _inner(v: Any, w: Any) -> Any:
    moved, stress = _stress(grad(w["displacement"]), w["first"], w["shear"])
    return ddot(mul(moved, stress), grad(v))


def _inverse(gradient: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    """The deformation gradient, its determinant, and its inverse transposed."""
    moved = gradient + eye(1.0 + 0.0 * gradient[0, 0], 3)
    return moved, det(moved), transpose(inv(moved))


@BilinearForm
def _rubber_tangent(u: Any, v: Any, w: Any) -> Any:
    _, volume, inverse = _inverse(grad(w["displacement"]))
    change = grad(u)
    back = w["shear"] - w["first"] * (volume - 1.0) * volume
    changed = w["shear"] * change + back * mul(inverse, mul(transpose(change), inverse))
    changed += w["first"] * (2.0 * volume - 1.0) * volume * ddot(inverse, change) * inverse
    return ddot(changed, grad(v))


@LinearForm
def _rubber_inner(v: Any, w: Any) -> Any:
    moved, volume, inverse = _inverse(grad(w["displacement"]))
    pressure = w["first"] * (volume - 1.0) * volume
    return ddot(w["shear"] * (moved - inverse) + pressure * inverse, grad(v))


# The weak forms of a law: of its tangent and of its stress.
Forms: TypeAlias = tuple[BilinearForm, LinearForm]
ST_VENANT_KIRCHHOFF = (_tangent, _inner)
NEO_HOOKEAN = (_rubber_tangent, _rubber_inner)


@dataclass(frozen=True, eq=False)
class NonlinearReference:
    """A body of 1 Pa by scikit-fem.

    Attributes
    ----------
    mesh : its tetrahedra.
    free : (f,), the nodes that are not pinned.
    poisson_ratio : below 0.5.
    forms : of the law, one of those above.
    """

    mesh: TetMesh
    free: NDArray[np.int64]
    poisson_ratio: float
    forms: Forms

    @cached_property
    def _basis(self) -> Basis:
        tets = MeshTet(self.mesh.nodes.T.copy(), self.mesh.tets.T.copy(), sort_t=False)
        return Basis(tets, ElementVector(ElementTetP1()), intorder=1)

    def displacements(self, forces: NDArray[np.float64], load_steps: int) -> NDArray[np.float64]:
        """Displacements (f, 3) under ``forces`` (f, 3) on the free nodes, in even load steps.

        Raises
        ------
        ArithmeticError
            Newton's method does not converge.
        """
        basis, (tangent_form, inner) = self._basis, self.forms
        first, shear = lame_parameters(1.0, self.poisson_ratio)
        freedoms = basis.nodal_dofs[:, self.free].T.ravel()
        u, load = np.zeros(basis.N), np.zeros(basis.N)
        for step in range(1, load_steps + 1):
            load[freedoms] = step / load_steps * forces.ravel()
            for _ in range(MOST_ITERATIONS):
                state = {"displacement": basis.interpolate(u), "first": first, "shear": shear}
                rest = (load - inner.assemble(basis, **state))[freedoms]
                if np.abs(rest).max() < CONVERGED * np.abs(load).max():
                    break
                tangent = tangent_form.assemble(basis, **state).tocsc()[freedoms][:, freedoms]
                factor = splu(tangent, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
                u[freedoms] += factor.solve(rest)
            else:
                raise ArithmeticError(f"no convergence at {step} of {load_steps} load steps")
        return u[freedoms].reshape(-1, 3)
