"""Rigid tools pressed into a body of a law: Newton's method on the energy of body and contact.

The body is the solid of its law, on its own tetrahedra and strains, the contact a penalty
at three places of each surface triangle. Nothing of Palpate's contact is used.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed.balance import Balance
from palpate.benchmarks.measuring.shape.pressed.contact import Contact, Held, Penalty, Spread
from palpate.benchmarks.measuring.shape.pressed.pressers import Presser
from palpate.core.body.soft_body import SoftBody
from palpate.core.shape.solid.free_solid import FreeSolid

Array = NDArray[np.float64]

# Places of a triangle that a tool is kept out of, each for a third of its area.
PLACES = np.array([[4.0, 1.0, 1.0], [1.0, 4.0, 1.0], [1.0, 1.0, 4.0]]) / 6.0
# Pressure over depth of what a tool is let in, times the mean edge of the surface and per pascal:
# to begin with, and at the end.
PENALTIES = (30.0, 300.0)
# A held point's spring, per pascal and metre of edge.
HOLD = 3e4


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
        touched = touched_surface(self.solid, self._triangles, outward)
        firm = [penalty / self.edge * touched.shares for penalty in PENALTIES]
        contacts = (Penalty(tool, penalty) for tool in tools for penalty in firm)
        yield from islice(self._followed(touched.spread, contacts), 1, None, len(firm))

    def by_point(self, triangle: int, alpha: Array, ways: Array) -> Iterator[Pressed]:
        """The body with a place of a surface triangle held where each of ``ways`` (k, 3) leads.

        Its force is spread over the nodes by area coordinates ``alpha`` (3,).

        Raises
        ------
        ArithmeticError
            Newton's method does not come to an end.
        """
        corners = np.searchsorted(self.solid.free, self.body.mesh.surface_triangles[triangle])
        yield from self._led(Spread(corners[None], alpha[None], self.solid), ways[:, None])

    def by_nodes(self, nodes: NDArray[np.int64], ways: Array) -> Iterator[Pressed]:
        """The body with free nodes (k,) of its mesh held where each of ``ways`` (m, k, 3) leads.

        Raises
        ------
        ArithmeticError
            Newton's method does not come to an end.
        """
        nodes = np.searchsorted(self.solid.free, nodes)
        yield from self._led(Spread.of_nodes(nodes, self.solid), ways)

    @cached_property
    def edge(self) -> float:
        """Of a usual triangle, metres."""
        return usual_edge(self.solid, self._triangles)

    def _led(self, spread: Spread, ways: Array) -> Iterator[Pressed]:
        rest = spread.places(np.zeros_like(self.solid.positions))
        firm = np.full(len(rest), HOLD * self.edge)
        yield from self._followed(spread, (Held(rest + way, firm) for way in ways))

    def _followed(self, spread: Spread, contacts: Iterator[Contact]) -> Iterator[Pressed]:
        moved, balance = np.zeros_like(self.solid.positions), Balance(spread)
        for contact in contacts:
            moved = balance.at_rest(contact, moved)
            pushes = contact.pushes(spread.places(moved))
            is_stable = balance.is_stable(pushes, moved)
            yield Pressed(moved, spread.on_nodes(pushes.forces), pushes.places, is_stable)

    @cached_property
    def _triangles(self) -> NDArray[np.int64]:
        """Surface triangles (t, 3) without pinned corners, by places in ``solid.free``."""
        triangles = self.body.mesh.surface_triangles
        free = ~np.isin(triangles, self.body.fixed).any(axis=1)
        return np.searchsorted(self.solid.free, triangles[free])


@dataclass(frozen=True, eq=False)
class TouchedSurface:
    """Places (p,) that tools are kept out of, and their shares of the surface, (p,), m2."""

    spread: Spread
    shares: Array


def touched_surface(
    solid: FreeSolid, triangles: NDArray[np.int64], outward: Array | None = None
) -> TouchedSurface:
    """Of triangles (t, 3), by places in ``solid.free``; of those that face along ``outward`` (3,),
    if it is given.
    """
    crosses = _crosses(solid, triangles)
    facing = slice(None) if outward is None else crosses @ outward > 0.0
    triangles = triangles[facing]
    alphas = np.tile(PLACES, (len(triangles), 1))
    shares = np.repeat(np.linalg.norm(crosses[facing], axis=1) / 6.0, 3)
    return TouchedSurface(Spread(np.repeat(triangles, 3, axis=0), alphas, solid), shares)


def usual_edge(solid: FreeSolid, triangles: NDArray[np.int64]) -> float:
    """Of a usual one of triangles (t, 3), by places in ``solid.free``; metres."""
    return float(np.sqrt(np.median(np.linalg.norm(_crosses(solid, triangles), axis=1))))


def _crosses(solid: FreeSolid, triangles: NDArray[np.int64]) -> Array:
    corners = solid.positions[triangles]
    crosses: Array = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return crosses
