"""A sphere pressed on a cube by a finite element method that shares nothing with Palpate.

Quadratic hexahedra of scikit-fem, a quarter of the cube with its symmetries, graded towards the
sphere. The body is linear, so its top stands for all of it (static condensation); the contact is
not: it is integrated over the deformed surface, by a penalty in the sphere's own distance, and
solved by Newton's method. The cube's bottom is fixed, or lies on a smooth floor: on springs as firm
as the penalty, which are taken away where it lifts off.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.sparse import block_diag, coo_array, csr_array, diags_array
from scipy.sparse.linalg import splu
from skfem import Basis, ElementHex2, ElementVector, FacetBasis, MeshHex
from skfem.models.elasticity import lame_parameters, linear_elasticity

# The penalty's stiffness in Young's moduli per smallest element: the sphere sinks in by less than
# a thousandth of the depth.
PENALTY = 300.0

# The smallest elements, at the sphere, in shares of those that an even grid would have.
SMALLEST = 0.2

MOST_ITERATIONS = 80
SMALLEST_STEP = 1.0 / 64.0
CONVERGED = 1e-9


@dataclass(frozen=True, eq=False)
class _Surface:
    """Quadrature on the top: ``places`` (q, 3), ``weights`` (q,), and ``moved`` (3q, n), which
    takes the unknowns to displacements there.
    """

    places: NDArray[np.float64]
    weights: NDArray[np.float64]
    moved: csr_array


@dataclass(frozen=True, eq=False)
class _Floor:
    """Springs ``firmness`` (q,) under the bottom, whose rise is ``upright`` (q, n) times u."""

    firmness: NDArray[np.float64]
    upright: csr_array

    def lifted(self, u: NDArray[np.float64]) -> tuple[NDArray[np.float64], csr_array]:
        """Forces (n,) that undo the springs where the bottom is above the floor, and their
        negative slope.
        """
        rise = self.upright @ u
        undone = self.firmness * (rise > 0.0)
        slope = -(self.upright.T @ diags_array(undone) @ self.upright)
        return self.upright.T @ (undone * rise), csr_array(slope)


def reference_forces(
    edge: float,
    radius: float,
    depths: Sequence[float],
    young: float,
    poisson_ratio: float,
    cells: int = 6,
    *,
    on_floor: bool = False,
) -> list[float]:
    """Forces, newton, on a sphere pressed straight down on the middle of the top of a cube with its
    bottom fixed, or ``on_floor``, at ascending ``depths``; metres and pascal. ``cells`` quadratic
    elements across the quarter.

    Raises
    ------
    ArithmeticError
        Newton's method does not converge.
    """
    first = SMALLEST * 0.5 * edge / cells
    across, down = _graded(0.5 * edge, cells, first), _graded(edge, cells + 2, first)
    mesh = MeshHex.init_tensor(across, across, (edge - down)[::-1])
    element = ElementVector(ElementHex2())
    inside = Basis(mesh, element, intorder=4)
    stiffness = linear_elasticity(*lame_parameters(young, poisson_ratio)).assemble(inside)
    low = inside.get_dofs(lambda x: x[2] < 1e-9 * edge).all()
    held = np.concatenate(
        [
            low[:0] if on_floor else low,
            inside.get_dofs(lambda x: x[0] < 1e-9 * edge).all(["u^1"]),
            inside.get_dofs(lambda x: x[1] < 1e-9 * edge).all(["u^2"]),
        ]
    )
    free = np.setdiff1d(np.arange(inside.N), held)
    upper = inside.get_dofs(lambda x: x[2] > edge * (1 - 1e-9)).all()
    upper = np.intersect1d(free, np.union1d(upper, low) if on_floor else upper)
    place = np.searchsorted(free, upper)
    factor = PENALTY * young / first
    floor = None
    if on_floor:
        bottom = _surface(mesh, element, lambda x: x[2] < 1e-9 * edge)
        upright = bottom.moved[2::3]
        stiffness = stiffness + factor * upright.T @ diags_array(bottom.weights) @ upright
        floor = _Floor(factor * bottom.weights, upright[:, upper])
    loads = np.zeros((len(free), len(upper)))
    loads[place, np.arange(len(upper))] = 1.0
    compliance = splu(stiffness.tocsr()[free][:, free].tocsc()).solve(loads)[place]
    whole = _surface(mesh, element, lambda x: x[2] > edge * (1 - 1e-9))
    top = _Surface(whole.places, whole.weights, whole.moved[:, upper])
    u = np.zeros(len(upper))
    forces = []
    for depth in depths:
        centre = np.array([0.0, 0.0, edge + radius - depth])
        u = _equilibrium(top, floor, compliance, u, centre, radius, factor)
        forces.append(-4.0 * _contact(top, u, centre, radius, factor)[2])
    return forces


def _equilibrium(
    top: _Surface,
    floor: _Floor | None,
    compliance: NDArray[np.float64],
    u: NDArray[np.float64],
    centre: NDArray[np.float64],
    radius: float,
    factor: float,
) -> NDArray[np.float64]:
    """Displacements (n,) that the penalty's own forces cause, by Newton's method with halving."""

    def pushed(u: NDArray[np.float64]) -> tuple[NDArray[np.float64], csr_array]:
        push, spring, _ = _contact(top, u, centre, radius, factor)
        if floor is None:
            return push, spring
        pull, soft = floor.lifted(u)
        return push + pull, spring + soft

    for _ in range(MOST_ITERATIONS):
        push, spring = pushed(u)
        missing = u - compliance @ push
        size = float(np.linalg.norm(missing))
        if size <= CONVERGED * radius:
            return u
        way = np.linalg.solve(np.eye(len(u)) + compliance @ spring.toarray(), missing)
        share = 1.0
        while share > SMALLEST_STEP:
            tried = u - share * way
            left = tried - compliance @ pushed(tried)[0]
            if np.linalg.norm(left) < size:
                break
            share *= 0.5
        u = u - share * way
    raise ArithmeticError("the reference did not converge; press in smaller steps")


def _surface(
    mesh: MeshHex,
    element: ElementVector,
    side: Callable[[NDArray[np.float64]], NDArray[np.bool_]],
) -> _Surface:
    facets = mesh.facets_satisfying(side)
    basis = FacetBasis(mesh, element, facets=facets, intorder=8)
    count = basis.dx.size
    rows, columns, values = [], [], []
    for local, dofs in enumerate(basis.element_dofs):
        value = np.broadcast_to(basis.basis[local][0].value, (3, *basis.dx.shape))
        for axis in range(3):
            rows.append(3 * np.arange(count) + axis)
            columns.append(np.repeat(dofs, basis.dx.shape[1]))
            values.append(value[axis].reshape(-1))
    moved = coo_array(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))),
        shape=(3 * count, basis.N),
    ).tocsr()
    places = np.asarray(basis.global_coordinates()).reshape(3, -1).T
    return _Surface(places, basis.dx.reshape(-1), moved)


def _contact(
    top: _Surface,
    u: NDArray[np.float64],
    centre: NDArray[np.float64],
    radius: float,
    factor: float,
) -> tuple[NDArray[np.float64], csr_array, float]:
    """Forces (n,) of the penalty, their negative slope (n, n), and their sum along z."""
    away = top.places + (top.moved @ u).reshape(-1, 3) - centre
    distance = np.linalg.norm(away, axis=1)
    normals = away / distance[:, None]
    overlap = np.maximum(radius - distance, 0.0)
    weights = factor * top.weights
    pressure = (weights * overlap)[:, None] * normals
    push, force = top.moved.T @ pressure.reshape(-1), float(pressure[:, 2].sum())
    inside = np.flatnonzero(overlap > 0.0)
    along = normals[inside, :, None] * normals[inside, None, :]
    aside = np.eye(3) - along
    bend = (overlap / distance)[inside, None, None]
    blocks = weights[inside, None, None] * (along - bend * aside)
    rows = (3 * inside[:, None] + np.arange(3)).reshape(-1)
    moved = top.moved[rows]
    if not inside.size:
        return push, csr_array((len(u), len(u))), force
    return push, (moved.T @ block_diag(blocks, format="csr") @ moved).tocsr(), force


def _graded(length: float, cells: int, first: float) -> NDArray[np.float64]:
    """Ticks from 0 to ``length``, the first cell ``first`` long, the others each larger."""
    growth = brentq(lambda q: first * (q**cells - 1) / (q - 1) - length, 1.0 + 1e-6, 20.0)
    ticks = np.concatenate([[0.0], np.cumsum(first * growth ** np.arange(cells))])
    ticks[-1] = length
    return ticks
