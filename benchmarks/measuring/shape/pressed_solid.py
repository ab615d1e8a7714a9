"""Rigid tools pressed into a body of a law: Newton's method on the energy of body and contact.

The body is the solid of its law, on its own tetrahedra and strains, the contact a penalty
at three places of each surface triangle. Nothing of Palpate's contact is used.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressers import Presser
from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.elimination.cholesky import CholeskyFactor, NotPositiveDefiniteError
from palpate.core.shape.solid.free_solid import FreeSolid

Array = NDArray[np.float64]

# Places of a triangle that a tool is kept out of, each for a third of its area.
PLACES = np.array([[4.0, 1.0, 1.0], [1.0, 4.0, 1.0], [1.0, 1.0, 4.0]]) / 6.0
# Pressure over depth of what a tool is let in, times the mean edge of the surface and per pascal:
# to begin with, and at the end.
PENALTIES = (30.0, 300.0)
# A held point's spring, per pascal and metre of edge.
HOLD = 300.0
# Forces left unbalanced, as a share of the mean of what presses.
RESIDUAL_SHARE = 1e-4
MOST_ITERATIONS = 120
SUFFICIENT_DECREASE = 1e-4
SHORTEST_PART = 1e-4


@dataclass(frozen=True, eq=False)
class Pushes:
    """What presses: energy in joule, forces (p, 3) on the places, and what resists, (p, 3, 3)."""

    energy: float
    forces: Array
    stiffness: Array


@dataclass(frozen=True, eq=False)
class Pressed:
    """The body at rest under what presses it; at unit modulus.

    Attributes
    ----------
    displacements : (f, 3) of the free nodes, metres.
    nodal_forces : (f, 3) on them.
    places : how many places press; fewer where few carry most of it.
    is_stable : whether the energy is least there; else it is an equilibrium that a body leaves.
    force : (3,) on the body.
    """

    displacements: Array
    nodal_forces: Array
    places: float
    is_stable: bool

    @property
    def force(self) -> Array:
        """All of it, (3,)."""
        total: Array = self.nodal_forces.sum(axis=0)
        return total


@dataclass(frozen=True, eq=False)
class PressedSolid:
    """A body with smoothed strains, to be pressed."""

    body: SoftBody

    @cached_property
    def solid(self) -> FreeSolid:
        """The material on the free nodes."""
        return FreeSolid.of(self.body)

    def by_tools(self, tools: list[Presser], outward: Array) -> Iterator[Pressed]:
        """The body under one tool after another, each from where the last one left it.

        Only the side that faces along ``outward`` (3,) can be touched.

        Raises
        ------
        ArithmeticError
            Newton's method does not come to an end.
        """
        facing = self._normals @ outward > 0.0
        triangles, shares = self._triangles[facing], np.repeat(self._areas[facing] / 3.0, 3)
        alphas = np.tile(PLACES, (len(triangles), 1))
        spread = _Spread(np.repeat(triangles, 3, axis=0), alphas, self.solid)
        firm = [penalty / self.edge * shares for penalty in PENALTIES]
        contacts = (_Penalty(tool, penalty) for tool in tools for penalty in firm)
        yield from islice(self._followed(spread, contacts), 1, None, len(firm))

    def by_point(self, triangle: int, alpha: Array, ways: Array) -> Iterator[Pressed]:
        """The body with a place of a surface triangle held where each of ``ways`` (k, 3) leads.

        Its force is spread over the nodes by area coordinates ``alpha`` (3,).

        Raises
        ------
        ArithmeticError
            Newton's method does not come to an end.
        """
        corners = np.searchsorted(self.solid.free, self.body.mesh.surface_triangles[triangle])
        spread = _Spread(corners[None], alpha[None], self.solid)
        rest = spread.places(np.zeros_like(self.solid.positions))
        yield from self._followed(spread, (_Held(rest + way, HOLD * self.edge) for way in ways))

    def by_nodes(self, nodes: NDArray[np.int64], ways: Array) -> Iterator[Pressed]:
        """The body with free nodes (k,) of its mesh held where each of ``ways`` (m, k, 3) leads.

        Raises
        ------
        ArithmeticError
            Newton's method does not come to an end.
        """
        corners = np.repeat(np.searchsorted(self.solid.free, nodes)[:, None], 3, axis=1)
        spread = _Spread(corners, np.tile([1.0, 0.0, 0.0], (len(nodes), 1)), self.solid)
        rest = spread.places(np.zeros_like(self.solid.positions))
        yield from self._followed(spread, (_Held(rest + way, HOLD * self.edge) for way in ways))

    @cached_property
    def edge(self) -> float:
        """Of a usual triangle, metres."""
        return float(np.sqrt(2.0 * np.median(self._areas)))

    def _followed(self, spread: _Spread, contacts: Iterator[_Contact]) -> Iterator[Pressed]:
        moved = np.zeros_like(self.solid.positions)
        for contact in contacts:
            moved = self._at_rest(spread, contact, moved)
            pushes = contact.pushes(spread.places(moved))
            sizes = np.linalg.norm(pushes.forces, axis=1)
            places = float(sizes.sum() ** 2 / max((sizes * sizes).sum(), 1e-300))
            is_stable = self._is_stable(spread, pushes, moved)
            yield Pressed(moved, spread.on_nodes(pushes.forces), places, is_stable)

    def _at_rest(self, spread: _Spread, contact: _Contact, moved: Array) -> Array:
        """Displacements (f, 3) of least energy, by Newton's method from ``moved``."""
        for _ in range(MOST_ITERATIONS):
            pushes = contact.pushes(spread.places(moved))
            left = spread.on_nodes(pushes.forces) - self.solid.forces(moved)
            pressed = int(np.count_nonzero(pushes.forces.any(axis=1)))
            mean = float(np.abs(pushes.forces).sum()) / max(pressed, 1)
            if float(np.abs(left).max()) <= RESIDUAL_SHARE * mean:
                return moved
            way = self._factor(spread, pushes, moved).solve(left.ravel()).reshape(-1, 3)
            further = self._searched(spread, contact, moved, way, float((left * way).sum()))
            if further is None:
                return moved
            moved = further
        raise ArithmeticError(f"no rest in {MOST_ITERATIONS} steps; press in smaller ones")

    def _factor(self, spread: _Spread, pushes: Pushes, moved: Array) -> CholeskyFactor:
        """Of the tangent or, where that leads uphill, of its convex part."""
        added = spread.blocks(pushes.stiffness)
        try:
            blocks = self.solid.solid.tangent_blocks(moved) + added
            return self.solid.elimination.factor(blocks)
        except NotPositiveDefiniteError:
            blocks = self.solid.solid.tangent_blocks(moved, convex=True) + added
            return self.solid.elimination.factor(blocks)

    def _is_stable(self, spread: _Spread, pushes: Pushes, moved: Array) -> bool:
        blocks = self.solid.solid.tangent_blocks(moved) + spread.blocks(pushes.stiffness)
        try:
            self.solid.elimination.factor(blocks)
        except NotPositiveDefiniteError:
            return False
        return True

    def _searched(
        self, spread: _Spread, contact: _Contact, moved: Array, way: Array, slope: float
    ) -> Array | None:
        def energy(at: Array) -> float:
            return self.solid.energy(at) + contact.pushes(spread.places(at)).energy

        before, part = energy(moved), 1.0
        while part >= SHORTEST_PART:
            if energy(moved + part * way) <= before - SUFFICIENT_DECREASE * part * slope:
                return moved + part * way
            part *= 0.5
        return None

    @cached_property
    def _triangles(self) -> NDArray[np.int64]:
        """Surface triangles (t, 3) without pinned corners, by places in ``solid.free``."""
        triangles = self.body.mesh.surface_triangles
        free = ~np.isin(triangles, self.body.fixed).any(axis=1)
        return np.searchsorted(self.solid.free, triangles[free])

    @cached_property
    def _crosses(self) -> Array:
        corners = self.solid.positions[self._triangles]
        crosses: Array = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        return crosses

    @property
    def _areas(self) -> Array:
        areas: Array = 0.5 * np.linalg.norm(self._crosses, axis=1)
        return areas

    @property
    def _normals(self) -> Array:
        return self._crosses / (2.0 * self._areas[:, None])


class _Contact(Protocol):
    def pushes(self, places: Array) -> Pushes: ...


@dataclass(frozen=True, eq=False)
class _Penalty:
    tool: Presser
    stiffness: Array

    def pushes(self, places: Array) -> Pushes:
        depth, normals = self.tool.depths(places)
        pressed = self.stiffness * np.maximum(depth, 0.0)
        firm = np.where(depth > 0.0, self.stiffness, 0.0)
        stiffness = np.einsum("p,pi,pj->pij", firm, normals, normals)
        return Pushes(0.5 * float(pressed @ depth), pressed[:, None] * normals, stiffness)


@dataclass(frozen=True, eq=False)
class _Held:
    goal: Array
    stiffness: float

    def pushes(self, places: Array) -> Pushes:
        missed = self.goal - places
        energy = 0.5 * self.stiffness * float((missed * missed).sum())
        stiffness = np.tile(self.stiffness * np.eye(3), (len(places), 1, 1))
        return Pushes(energy, self.stiffness * missed, stiffness)


@dataclass(frozen=True, eq=False)
class _Spread:
    """Places (p,) in triangles: corners (p, 3) by places in ``solid.free``, area coordinates."""

    corners: NDArray[np.int64]
    alphas: Array
    solid: FreeSolid

    def places(self, moved: Array) -> Array:
        """Where they are, (p, 3), at displacements (f, 3)."""
        corners = self.solid.positions[self.corners] + moved[self.corners]
        return np.asarray(np.einsum("pa,pai->pi", self.alphas, corners))

    def on_nodes(self, forces: Array) -> Array:
        """Forces (p, 3) as forces on the nodes, (f, 3)."""
        found = np.zeros_like(self.solid.positions)
        np.add.at(found, self.corners, self.alphas[:, :, None] * forces[:, None, :])
        return found

    def blocks(self, stiffness: Array) -> Array:
        """Stiffness (p, 3, 3) of the places as blocks (m, 3, 3) of the body's tangents."""
        pattern = self.solid.solid.pattern
        found = np.zeros((len(pattern.rows), 3, 3))
        acts = stiffness.any(axis=(1, 2))
        added = np.einsum("pa,pb,pij->pabij", self.alphas[acts], self.alphas[acts], stiffness[acts])
        np.add.at(found, self._pairs[acts], added)
        return found

    @cached_property
    def _pairs(self) -> NDArray[np.int64]:
        """Where each two corners of a place stand in the tangents' pattern, (p, 3, 3)."""
        pattern, count = self.solid.solid.pattern, self.solid.node_count
        keys = pattern.rows * count + pattern.columns
        return np.searchsorted(keys, self.corners[:, :, None] * count + self.corners[:, None, :])
