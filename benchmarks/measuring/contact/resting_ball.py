"""A ball on a table or glued to it, pressed from above, by scikit-fem; without friction.

Linear and axially symmetric: quadratic triangles in the half plane (r, z), finer towards the poles,
with its own assembly. A plate or a sphere above and the table below are kept out of the ball's true
outline, as it is moved, by a penalty; Newton's method with a line search on the energy. Nothing is
shared with Palpate.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP2, ElementVector, FacetBasis, MeshTri

Array = NDArray[np.float64]

MOST_ITERATIONS = 60
CONVERGED = 1e-9
# What of the ball may meet anything: within this share of its radius from its axis.
WIDEST = 0.9


@dataclass(frozen=True, eq=False)
class RestingBall:
    """A ball of radius 1 and of 1 Pa; its lowest point is the origin.

    Attributes
    ----------
    poisson_ratio : below 0.5.
    refined : how often the triangles at the poles are divided, each time nearer to the poles.
    penalty : pressure over depth of what the obstacles are let in.
    glued : surface up to this height is held, and there is no table; 0 for the table.
    """

    poisson_ratio: float = 0.45
    refined: int = 5
    penalty: float = 2_000.0
    glued: float = 0.0

    def under_plate(self, depth: float) -> tuple[float, float]:
        """Force on a plate that comes down by ``depth``, and the radius of its patch."""
        return self._pressed(lambda places: _from_plate(places, 2.0 - depth), depth)

    def under_sphere(self, radius: float, depth: float) -> tuple[float, float]:
        """Force on a sphere of ``radius`` that comes down by ``depth``, and that of the table's
        patch.
        """
        centre = 2.0 + radius - depth
        return self._pressed(lambda places: _from_sphere(places, centre, radius), depth)

    def spread_under_sphere(self, radius: float, depth: float) -> tuple[float, float]:
        """The same force, and how wide the table presses: the root of the mean square of the
        distance from the axis, weighed by the pressure.
        """
        centre = 2.0 + radius - depth

        def above(places: Array) -> Any:
            return _from_sphere(places, centre, radius)

        u = self._at_rest(above, depth)
        places = self._places(u)
        pressure = self._weights * np.maximum(-places[:, 1], 0.0)
        square = float(pressure @ places[:, 0] ** 2) / float(pressure.sum())
        return self._force(u, above), float(np.sqrt(square))

    def _pressed(self, above: Any, depth: float) -> tuple[float, float]:
        """Force and radius of the lower patch, or of the only one."""
        u = self._at_rest(above, depth)
        return self._force(u, above), self._patch(u, above)

    def _at_rest(self, above: Any, depth: float) -> Array:
        """Displacements at rest."""
        u = np.zeros(self._basis.N)
        # So both touch from the beginning, and nothing is without a hold.
        u[self._upright] = 0.0 if self.glued else -0.5 * depth
        u[self._held] = 0.0
        sizes: list[float] = []
        for _ in range(MOST_ITERATIONS):
            energy, left, tangent = self._system(u, above)
            free = self._free
            sizes.append(float(np.abs(left[free]).max()))
            force = self._force(u, above)
            if sizes[-1] < CONVERGED * max(force, 1e-12):
                return u
            way = splu(tangent[free][:, free].tocsc()).solve(-left[free])
            share = 1.0
            while share > 1e-6:
                tried = u.copy()
                tried[free] += share * way
                if self._system(tried, above)[0] <= energy * (1.0 + 1e-13):
                    break
                share *= 0.5
            u = tried
        raise ArithmeticError(f"no end at a depth of {depth}: {sizes[-3:]}")

    def _force(self, u: Array, above: Any) -> float:
        distance, normals, _ = above(self._places(u))
        return -float(self.penalty * (self._weights * np.maximum(-distance, 0.0)) @ normals[:, 1])

    def _patch(self, u: Array, above: Any) -> float:
        places = self._places(u)
        distance = above(places)[0] if self.glued else places[:, 1]
        return float(places[distance < 0.0, 0].max(initial=0.0))

    def _system(self, u: Array, above: Any) -> tuple[float, Array, csr_array]:
        """Energy, its slope and its tangent."""
        pushed = self._stiffness @ u
        energy, tangent = 0.5 * float(u @ pushed), self._stiffness
        places = self._places(u)
        for distance, normals, bent in [above(places), *([] if self.glued else [_table(places)])]:
            inside = np.maximum(-distance, 0.0)
            weights = self.penalty * self._weights
            energy += 0.5 * float(weights @ inside**2)
            pushed = pushed - self._moved.T @ ((weights * inside)[:, None] * normals).ravel()
            across = normals[:, ::-1] * [1.0, -1.0]
            for axis, size in (
                (normals, weights * (inside > 0.0)),
                (across, -weights * inside * bent),
            ):
                rows = np.repeat(np.arange(len(axis)), 2)
                along = csr_array(
                    (axis.ravel(), (rows, np.arange(axis.size))), (len(axis), axis.size)
                )
                seen = along @ self._moved
                tangent = tangent + seen.T @ diags_array(size) @ seen
        return energy, pushed, tangent.tocsr()

    @cached_property
    def _basis(self) -> Basis:
        mesh = MeshTri.init_circle(3)
        mesh = mesh.restrict(np.flatnonzero(mesh.p[0, mesh.t].mean(axis=0) > 0.0))
        reach = 0.8
        for _ in range(self.refined):
            centres = mesh.p[:, mesh.t].mean(axis=1)
            pole = np.hypot(centres[0], 1.0 - np.abs(centres[1]))
            mesh = _rounded(mesh.refined(np.flatnonzero(pole < reach)))
            reach *= 0.62
        mesh = mesh.translated((0.0, 1.0))
        return Basis(mesh, ElementVector(ElementTriP2()), intorder=5)

    @cached_property
    def _stiffness(self) -> csr_array:
        ratio = self.poisson_ratio
        moduli = {"first": ratio / ((1 + ratio) * (1 - 2 * ratio)), "shear": 0.5 / (1 + ratio)}
        return csr_array(_stretched.assemble(self._basis, **moduli))

    @cached_property
    def _skin(self) -> FacetBasis:
        mesh = self._basis.mesh
        facets = mesh.facets_satisfying(
            lambda x: (np.hypot(x[0], x[1] - 1) > 0.98) & (x[0] < WIDEST), boundaries_only=True
        )
        return FacetBasis(mesh, self._basis.elem, facets=facets, intorder=8)

    @cached_property
    def _rest(self) -> Array:
        """Places on the true circle, (q, 2), of the skin's points."""
        places = np.asarray(self._skin.global_coordinates()).reshape(2, -1).T - [0.0, 1.0]
        rounded: Array = places / np.linalg.norm(places, axis=1)[:, None] + [0.0, 1.0]
        return rounded

    @cached_property
    def _weights(self) -> Array:
        return 2.0 * np.pi * self._rest[:, 0] * self._skin.dx.reshape(-1)

    @cached_property
    def _moved(self) -> csr_array:
        """Takes the unknowns to displacements of the skin's points, (2q, n)."""
        count = self._skin.dx.size
        rows, columns, values = [], [], []
        for local, unknowns in enumerate(self._skin.element_dofs):
            value = np.broadcast_to(self._skin.basis[local][0].value, (2, *self._skin.dx.shape))
            for axis in range(2):
                rows.append(2 * np.arange(count) + axis)
                columns.append(np.repeat(unknowns, self._skin.dx.shape[1]))
                values.append(value[axis].reshape(-1))
        entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
        return csr_array(entries, shape=(2 * count, self._basis.N))

    def _places(self, u: Array) -> Array:
        return self._rest + (self._moved @ u).reshape(-1, 2)

    @cached_property
    def _upright(self) -> NDArray[np.int64]:
        return np.concatenate([self._basis.nodal_dofs[1], self._basis.facet_dofs[1]])

    @cached_property
    def _held(self) -> NDArray[np.int64]:
        held = self._basis.get_dofs(lambda x: np.isclose(x[0], 0.0)).all(["u^1"])
        if not self.glued:
            return held
        low = self._basis.get_dofs(
            lambda x: (np.hypot(x[0], x[1] - 1) > 0.97) & (x[1] <= self.glued)
        )
        return np.union1d(held, low.all())

    @cached_property
    def _free(self) -> NDArray[np.int64]:
        return np.setdiff1d(np.arange(self._basis.N), self._held)


def _rounded(mesh: MeshTri) -> MeshTri:
    """The mesh with all of its rim on the circle."""
    rim = mesh.boundary_nodes()
    rim = rim[mesh.p[0, rim] > 1e-9]
    places = mesh.p.copy()
    places[:, rim] /= np.linalg.norm(places[:, rim], axis=0)
    return MeshTri(places, mesh.t)


def _table(places: Array) -> tuple[Array, Array, Array]:
    """Distance, normal, and its turn with a move aside."""
    return places[:, 1], np.tile([0.0, 1.0], (len(places), 1)), np.zeros(len(places))


def _from_plate(places: Array, height: float) -> tuple[Array, Array, Array]:
    return height - places[:, 1], np.tile([0.0, -1.0], (len(places), 1)), np.zeros(len(places))


def _from_sphere(places: Array, centre: float, radius: float) -> tuple[Array, Array, Array]:
    away = places - [0.0, centre]
    far = np.linalg.norm(away, axis=1)
    return far - radius, away / far[:, None], 1.0 / far


@BilinearForm
def _stretched(u: Any, v: Any, w: Any) -> Any:
    r = w.x[0]
    round_u, round_v = u[0] / r, v[0] / r
    gu, gv = u.grad, v.grad
    volumes = (gu[0, 0] + gu[1, 1] + round_u) * (gv[0, 0] + gv[1, 1] + round_v)
    straight = gu[0, 0] * gv[0, 0] + gu[1, 1] * gv[1, 1] + round_u * round_v
    sheared = 0.5 * (gu[0, 1] + gu[1, 0]) * (gv[0, 1] + gv[1, 0])
    stress = w["first"] * volumes + 2.0 * w["shear"] * (straight + sheared)
    return 2.0 * np.pi * r * stress
