"""A rigid ball pressed into a cylinder of neo-Hookean rubber, without friction, by scikit-fem.

Axially symmetric: quadratic triangles in the half plane (r, z), its own assembly, Newton's method
with a line search on the energy of rubber and contact. The ball, which continues as a shaft of its
radius, is kept out by a penalty. Nothing is shared with Palpate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from skfem import (
    Basis,
    BilinearForm,
    ElementTriP2,
    ElementVector,
    FacetBasis,
    Functional,
    LinearForm,
    MeshTri,
)

Array = NDArray[np.float64]

CONVERGED = 1e-8
# Where the energy tells no better place any more, this share may be left.
ROUNDING = 1e-5
MOST_ITERATIONS = 80
SHORTEST_PART = 1e-6


def graded(first: float, ratio: float, total: float) -> Array:
    """Places from 0 to ``total``, ever farther apart by ``ratio``, the first by about ``first``."""
    places = [0.0]
    step = first
    while places[-1] < total:
        places.append(places[-1] + step)
        step *= ratio
    return np.array(places) * (total / places[-1])


@dataclass(frozen=True, eq=False)
class PressedCylinder:
    """Rubber of 1 Pa, held below, under a ball of radius 1.

    Attributes
    ----------
    poisson_ratio : below 0.5.
    first : length of the smallest edges, beneath the ball.
    size : radius and height, enough to stand for a half-space.
    penalty : pressure over depth of what the ball is let in.
    """

    poisson_ratio: float = 0.49
    first: float = 0.09
    size: float = 50.0
    penalty: float = 350.0

    def forces(self, depths: Sequence[float]) -> Array:
        """Forces (k,) at depths that grow, in turn.

        Raises
        ------
        ArithmeticError
            Newton's method does not come to an end.
        """
        basis, free = self._basis, self._free
        u, found = basis.zeros(), []
        for depth in depths:
            energy = self._energy(u, depth)
            for _ in range(MOST_ITERATIONS):
                rest, tangent, pushes = self._system(u, depth)
                left = rest[free]
                share = np.abs(left).max() / max(np.abs(pushes).max(), 1e-12)
                if share < CONVERGED:
                    break
                own = tangent[free][:, free]
                way = splu(own, permc_spec="COLAMD").solve(-left)
                way *= -np.sign(left @ way)
                further = self._searched(u, depth, energy, way, float(left @ way))
                if further is None and share < ROUNDING:
                    break
                if further is None:
                    raise ArithmeticError(f"no way down at a depth of {depth}")
                u, energy = further
            else:
                raise ArithmeticError(f"no end at a depth of {depth}")
            along = np.concatenate([basis.nodal_dofs[1], basis.facet_dofs[1]])
            found.append(float(self._system(u, depth)[2][along].sum()))
        return np.array(found)

    @cached_property
    def _basis(self) -> Basis:
        places = graded(self.first, 1.25, self.size)
        mesh = MeshTri.init_tensor(places, -places[::-1])
        return Basis(mesh, ElementVector(ElementTriP2()), intorder=4)

    @cached_property
    def _top(self) -> FacetBasis:
        mesh = self._basis.mesh
        facets = mesh.facets_satisfying(lambda x: np.isclose(x[1], 0.0), boundaries_only=True)
        return FacetBasis(mesh, self._basis.elem, facets=facets, intorder=8)

    @cached_property
    def _free(self) -> NDArray[np.int64]:
        below = self._basis.get_dofs(lambda x: np.isclose(x[1], -self.size)).all()
        axis = self._basis.get_dofs(lambda x: np.isclose(x[0], 0.0)).all("u^1")
        return np.setdiff1d(np.arange(self._basis.N), np.concatenate([below, axis]))

    @property
    def _moduli(self) -> dict[str, float]:
        ratio = self.poisson_ratio
        first = ratio / ((1 + ratio) * (1 - 2 * ratio))
        return {"first": first, "shear": 0.5 / (1 + ratio), "penalty": self.penalty}

    def _searched(
        self, u: Array, depth: float, energy: float, way: Array, slope: float
    ) -> tuple[Array, float] | None:
        part = 1.0
        while part > SHORTEST_PART:
            trial = u.copy()
            trial[self._free] += part * way
            reached = self._energy(trial, depth)
            if np.isfinite(reached) and reached <= energy + 1e-4 * part * slope + 1e-12 * energy:
                return trial, reached
            part *= 0.5
        return None

    def _energy(self, u: Array, depth: float) -> float:
        inside = {"u": self._basis.interpolate(u), **self._moduli}
        pressed = {"u": self._top.interpolate(u), "depth": depth, **self._moduli}
        with np.errstate(all="ignore"):
            total = _stored.assemble(self._basis, **inside)
            return float(total + _let_in.assemble(self._top, **pressed))

    def _system(self, u: Array, depth: float) -> tuple[Array, Any, Array]:
        inside = {"u": self._basis.interpolate(u), **self._moduli}
        pressed = {"u": self._top.interpolate(u), "depth": depth, **self._moduli}
        pushes = _pushed.assemble(self._top, **pressed)
        tangent = _tangent.assemble(self._basis, **inside)
        tangent = (tangent + _push_tangent.assemble(self._top, **pressed)).tocsc()
        return _stress.assemble(self._basis, **inside) + pushes, tangent, pushes


def _moved(w: Any) -> tuple[Any, ...]:
    """F in the plane by rows, and round the axis; determinants in the plane and of all; 2 pi r."""
    g = w["u"].grad
    a, b, c, d = 1 + g[0, 0], g[0, 1], g[1, 0], 1 + g[1, 1]
    round_axis, plane = 1 + w["u"][0] / w.x[0], a * d - b * c
    return a, b, c, d, round_axis, plane, plane * round_axis, 2 * np.pi * w.x[0]


@Functional
def _stored(w: Any) -> Any:
    a, b, c, d, t, _, volume, weight = _moved(w)
    square = a * a + b * b + c * c + d * d + t * t
    shape = w["shear"] / 2 * (square - 3 - 2 * np.log(np.where(volume > 0, volume, np.nan)))
    return weight * (shape + w["first"] / 2 * (volume - 1) ** 2)


@LinearForm
def _stress(v: Any, w: Any) -> Any:
    a, b, c, d, t, plane, volume, weight = _moved(w)
    shear, gv = w["shear"], v.grad
    q = w["first"] * (volume - 1) - shear / volume
    inside = (shear * a + q * t * d) * gv[0, 0] + (shear * b - q * t * c) * gv[0, 1]
    inside += (shear * c - q * t * b) * gv[1, 0] + (shear * d + q * t * a) * gv[1, 1]
    return weight * (inside + (shear * t + q * plane) * v[0] / w.x[0])


@BilinearForm
def _tangent(p: Any, v: Any, w: Any) -> Any:
    a, b, c, d, t, plane, volume, weight = _moved(w)
    shear, first, r = w["shear"], w["first"], w.x[0]
    gp, gv, pt, vt = p.grad, v.grad, p[0] / r, v[0] / r

    def of_plane(h: Any) -> Any:
        return d * h[0, 0] + a * h[1, 1] - c * h[0, 1] - b * h[1, 0]

    plane_p, plane_v = of_plane(gp), of_plane(gv)
    volumes = (t * plane_p + plane * pt) * (t * plane_v + plane * vt)
    mixed = gp[0, 0] * gv[1, 1] + gp[1, 1] * gv[0, 0] - gp[0, 1] * gv[1, 0] - gp[1, 0] * gv[0, 1]
    mixed = t * mixed + pt * plane_v + vt * plane_p
    inner = sum(gp[i, j] * gv[i, j] for i in (0, 1) for j in (0, 1)) + pt * vt
    q = first * (volume - 1) - shear / volume
    return weight * (shear * inner + (first + shear / volume**2) * volumes + q * mixed)


def _distance(w: Any) -> tuple[Any, Any, Any, Any]:
    """Distance from the ball and its shaft, the normal there, and the curvature."""
    r, z = w.x[0] + w["u"][0], w.x[1] + w["u"][1]
    below = z - (1.0 - w["depth"])
    on_ball, far = below < 0.0, np.sqrt(r * r + below * below)
    normal = np.where(on_ball, r / far, 1.0), np.where(on_ball, below / far, 0.0)
    return (
        np.minimum(np.where(on_ball, far, r) - 1.0, 0.0),
        *normal,
        np.where(on_ball, 1 / far, 0.0),
    )


@Functional
def _let_in(w: Any) -> Any:
    return np.pi * w.x[0] * w["penalty"] * _distance(w)[0] ** 2


@LinearForm
def _pushed(v: Any, w: Any) -> Any:
    depth, nr, nz, _ = _distance(w)
    return 2 * np.pi * w.x[0] * w["penalty"] * depth * (nr * v[0] + nz * v[1])


@BilinearForm
def _push_tangent(p: Any, v: Any, w: Any) -> Any:
    depth, nr, nz, curved = _distance(w)
    straight = (nr * v[0] + nz * v[1]) * (nr * p[0] + nz * p[1])
    across = (nz * p[0] - nr * p[1]) * (nz * v[0] - nr * v[1])
    return 2 * np.pi * w.x[0] * w["penalty"] * ((depth < 0) * straight + depth * curved * across)
