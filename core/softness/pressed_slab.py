"""A round slab under a rigid flat disc, by a law of materials: finite elements, axially symmetric.

Four-node elements in the half plane (r, z). What grows with the shear modulus is integrated at four
places of an element, what grows with Lame's first parameter at its middle, so that nothing locks.
The slab slides on its table and under the disc; nothing is lifted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import splu

from ..errors import PalpateError
from ..law.law import Law, convex_part
from ..stiffness.assembly import lame_parameters

Array = NDArray[np.float64]

# Cells of the slab: under the disc, beside it, and in height.
UNDER, BESIDE, HIGH = 12, 8, 10
# Steps of depth at least this fine, as shares of the thickness; halved where Newton's method fails.
STEP, SHORTEST_STEP = 0.025, 0.001
CONVERGED, MOST_ITERATIONS = 1e-8, 30
# Reduced parts of a Newton step that are tried.
SHORTEST_PART = 1e-4
# Gauss's two places on a side of a square from -1 to 1.
GAUSS = 1.0 / np.sqrt(3.0)


@dataclass(frozen=True, eq=False)
class PressedSlab:
    """A slab of 1 Pa.

    Attributes
    ----------
    law : of its material.
    poisson_ratio : between -1 and 0.5, both excluded.
    radius, thickness : of the slab, metres.
    disc : radius of the disc, metres.
    """

    law: Law
    poisson_ratio: float
    radius: float
    thickness: float
    disc: float

    def forces(self, shares: Sequence[float]) -> Array:
        """Forces (k,), newton, with the disc ``shares`` of the thickness deep, ascending.

        Raises
        ------
        PalpateError
            Newton's method finds no equilibrium.
        """
        return np.array([self._force(u) for u in self.shapes(shares)])

    def shapes(self, shares: Sequence[float]) -> list[Array]:
        """Displacements (n, 2) of :attr:`places`, metres, at each of ``shares``, ascending."""
        u, reached, found = np.zeros(self.places.shape), 0.0, []
        for share in shares:
            step = STEP
            while reached < share - 1e-12:
                aim = min(reached + step, share)
                settled = self._settled(self._led(u, reached, aim))
                if settled is None and step < SHORTEST_STEP:
                    raise PalpateError(
                        "indentation: no equilibrium at {share:.0%} of the thickness; "
                        "ask for less, or for another law",
                        share=aim,
                    )
                if settled is None:
                    step *= 0.5
                else:
                    u, reached = settled, aim
            found.append(u)
        return found

    @cached_property
    def places(self) -> Array:
        """Nodes (n, 2), r and z at rest, metres, layer by layer from below; closest at the disc's
        edge.
        """
        r, z = self._levels
        return np.column_stack([np.tile(r, len(z)), np.repeat(z, len(r))])

    @cached_property
    def _levels(self) -> tuple[Array, Array]:
        disc = min(self.disc, self.radius)
        under = disc * np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, UNDER + 1))
        beside = disc + (self.radius - disc) * np.linspace(0.0, 1.0, BESIDE + 1)[1:] ** 1.5
        # A disc over the whole slab has nothing beside it.
        r = under if self.disc >= self.radius else np.concatenate([under, beside])
        return r, self.thickness * np.linspace(0.0, 1.0, HIGH + 1)

    @cached_property
    def _cells(self) -> NDArray[np.int64]:
        r, z = self._levels
        i, j = np.meshgrid(np.arange(len(r) - 1), np.arange(len(z) - 1))
        first = (i + len(r) * j).ravel()
        return np.column_stack([first, first + 1, first + len(r) + 1, first + len(r)])

    @cached_property
    def _pressed(self) -> NDArray[np.bool_]:
        r, z = self.places.T
        pressed: NDArray[np.bool_] = (r <= self.disc * (1 + 1e-9)) & (z == z.max())
        return pressed

    @cached_property
    def _free(self) -> NDArray[np.int64]:
        r, z = self.places.T
        held = np.column_stack([r == 0.0, (z == 0.0) | self._pressed])
        return np.flatnonzero(~held.ravel())

    def _led(self, u: Array, reached: float, aim: float) -> Array:
        """Displacements with the disc at its aim: all beneath it goes down in proportion."""
        moved = u.copy()
        lower = (1.0 - aim) / (1.0 - reached)
        under = self.places[:, 0] <= self.disc * (1 + 1e-9)
        z = self.places[:, 1] + u[:, 1]
        moved[under, 1] = z[under] * lower - self.places[under, 1]
        moved[self._pressed, 1] = -aim * self.thickness
        return moved

    @cached_property
    def _integrals(self) -> list[tuple[csr_array, Array, float, float]]:
        """Of both parts: gradients (9 d, 2 n), weights (d,), Lame's parameter, shear modulus."""
        first, shear = lame_parameters(1.0, self.poisson_ratio)
        corners = [(x, y) for x in (-GAUSS, GAUSS) for y in (-GAUSS, GAUSS)]
        whole = (*self._gradients(corners), 0.0, shear)
        return [whole, (*self._gradients([(0.0, 0.0)]), first, 0.0)] if first else [whole]

    def _gradients(self, at: list[tuple[float, float]]) -> tuple[csr_array, Array]:
        rows, columns, values, weights = [], [], [], []
        count, corners = len(self._cells), self.places[self._cells]
        signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], dtype=np.float64)
        for number, (x, y) in enumerate(at):
            shape = 0.25 * (1 + signs[:, 0] * x) * (1 + signs[:, 1] * y)
            slope = 0.25 * np.column_stack(
                [signs[:, 0] * (1 + signs[:, 1] * y), signs[:, 1] * (1 + signs[:, 0] * x)]
            )
            jacobian = np.einsum("ca,mcx->max", slope, corners)
            grown = np.einsum("mxa,ca->mcx", np.linalg.inv(jacobian), slope)
            r = corners[:, :, 0] @ shape
            weights.append(2 * np.pi * r * np.linalg.det(jacobian) * (4.0 / len(at)))
            place = 9 * (number * count + np.arange(count))[:, None]
            # Of F by rows: r, round the axis, z.
            parts = (
                (0, 0, grown[:, :, 0]),
                (2, 0, grown[:, :, 1]),
                (4, 0, shape / r[:, None]),
                (6, 1, grown[:, :, 0]),
                (8, 1, grown[:, :, 1]),
            )
            for component, axis, value in parts:
                rows.append(np.broadcast_to(place + component, value.shape).ravel())
                columns.append((2 * self._cells + axis).ravel())
                values.append(value.ravel())
        entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
        size = (9 * count * len(at), 2 * len(self.places))
        return csr_array(entries, shape=size), np.concatenate(weights)

    def _energy(self, u: Array) -> float:
        total = 0.0
        for gradients, weights, first, shear in self._integrals:
            found = self.law.stressed(*self._asked(gradients, u, first, shear))
            total += float(found.density @ weights)
        return total

    def _rest(self, u: Array) -> Array:
        """Forces (2 n,) that hold the slab."""
        total = np.zeros(u.size)
        for gradients, weights, first, shear in self._integrals:
            stress = self.law.stressed(*self._asked(gradients, u, first, shear)).stress
            total += gradients.T @ (stress.reshape(9, -1) * weights).T.ravel()
        return total

    def _tangent(self, u: Array, *, convex: bool) -> csc_array:
        total = csc_array((u.size, u.size))
        for gradients, weights, first, shear in self._integrals:
            blocks = self.law.tangent(*self._asked(gradients, u, first, shear))
            blocks = (convex_part(blocks) if convex else blocks) * weights[:, None, None]
            count = len(weights)
            rows = 9 * np.arange(count)[:, None, None] + np.arange(9)[:, None]
            columns = 9 * np.arange(count)[:, None, None] + np.arange(9)
            places = [np.broadcast_to(side, blocks.shape).ravel() for side in (rows, columns)]
            entries = blocks.ravel(), (places[0], places[1])
            middle = csr_array(entries, shape=(9 * count, 9 * count))
            total = total + gradients.T @ middle @ gradients
        return csc_array(total)

    def _asked(
        self, gradients: csr_array, u: Array, first: float, shear: float
    ) -> tuple[Array, Array, Array]:
        changed = (gradients @ u.ravel()).reshape(-1, 9).T.reshape(3, 3, -1)
        count = changed.shape[2]
        return np.ascontiguousarray(changed), np.full(count, first), np.full(count, shear)

    def _settled(self, u: Array) -> Array | None:
        """At rest by Newton's method, or None where it finds no end.

        Where the whole tangent leads nowhere lower, its convex part is taken.
        """
        energy = self._energy(u)
        for _ in range(MOST_ITERATIONS):
            held = self._rest(u)
            left = held[self._free]
            if np.abs(left).max() <= CONVERGED * np.abs(held).max():
                return u
            for convex in (False, True):
                further = self._lower(u, energy, left, convex=convex)
                if further is not None:
                    break
            else:
                return None
            u, energy = further
        return None

    def _lower(
        self, u: Array, energy: float, left: Array, *, convex: bool
    ) -> tuple[Array, float] | None:
        """A place of no more energy on the way of Newton's step, and its energy."""
        own = self._tangent(u, convex=convex)[self._free][:, self._free].tocsc()
        step = splu(own).solve(-left)
        if not step @ left < 0.0:
            return None
        way = np.zeros(u.shape)
        way.flat[self._free] = step
        part = 1.0
        while part >= SHORTEST_PART:
            moved = u + part * way
            reached = self._energy(moved)
            if reached <= energy * (1.0 + 1e-12):
                return moved, reached
            part *= 0.5
        return None

    def _force(self, u: Array) -> float:
        return -float(self._rest(u).reshape(u.shape)[self._pressed, 1].sum())
