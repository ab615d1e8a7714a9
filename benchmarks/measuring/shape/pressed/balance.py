"""A solid at rest under what presses it: Newton's method on the energy of both."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed.contact import Contact, Pushes, Spread
from palpate.core.compliance.elimination.cholesky import CholeskyFactor, NotPositiveDefiniteError

Array = NDArray[np.float64]

# Forces left unbalanced, as a share of the mean of what presses.
RESIDUAL_SHARE = 1e-4
MOST_ITERATIONS = 120
SUFFICIENT_DECREASE = 1e-4
SHORTEST_PART = 1e-4
# By how much the tangent is made firmer where it leads uphill, over a node's own stiffness.
FIRMER = (0.0, 1e-4, 1e-2)


@dataclass(frozen=True, eq=False)
class Balance:
    """A solid that is pressed at some places, until no more than a share is unbalanced."""

    spread: Spread
    residual_share: float = RESIDUAL_SHARE

    def at_rest(self, contact: Contact, moved: Array) -> Array:
        """Displacements (f, 3) of least energy, by Newton's method from ``moved``.

        Raises
        ------
        ArithmeticError
            Newton's method does not come to an end.
        """
        for _ in range(MOST_ITERATIONS):
            pushes = contact.pushes(self.spread.places(moved))
            left = self.spread.on_nodes(pushes.forces) - self.spread.solid.forces(moved)
            if float(np.abs(left).max()) <= self.residual_share * pushes.usual:
                return moved
            way = self._factor(pushes, moved).solve(left.ravel()).reshape(-1, 3)
            further = self._searched(contact, moved, way, float((left * way).sum()))
            if further is None:
                return moved
            moved = further
        raise ArithmeticError(f"no rest in {MOST_ITERATIONS} steps; press in smaller ones")

    def is_stable(self, pushes: Pushes, moved: Array) -> bool:
        """Whether the energy is least at displacements (f, 3), which are at rest."""
        solid = self.spread.solid
        blocks = solid.solid.tangent_blocks(moved) + self.spread.blocks(pushes.stiffness)
        try:
            solid.elimination.factor(blocks)
        except NotPositiveDefiniteError:
            return False
        return True

    def _factor(self, pushes: Pushes, moved: Array) -> CholeskyFactor:
        """Of the tangent or, where that leads uphill, of the first that does not of what is ever
        farther from it.
        """
        for blocks in self._ever_firmer(pushes, moved):
            try:
                return self.spread.solid.elimination.factor(blocks)
            except NotPositiveDefiniteError:
                continue
        raise ArithmeticError("nothing leads downhill")

    def _ever_firmer(self, pushes: Pushes, moved: Array) -> Iterator[Array]:
        solid = self.spread.solid.solid
        blocks, convex = solid.tangent_blocks(moved), self.spread.blocks(pushes.convex)
        yield blocks + self.spread.blocks(pushes.stiffness)
        for share in FIRMER:
            yield blocks + convex + share * self._firm
        yield solid.tangent_blocks(moved, convex=True) + convex

    @cached_property
    def _firm(self) -> Array:
        """As firm as a node at rest, for each on its own, (m, 3, 3)."""
        solid = self.spread.solid
        at_rest = solid.solid.tangent_blocks(np.zeros((solid.node_count, 3)))
        firm = np.zeros_like(at_rest)
        firm[solid.solid.pattern.own] = solid.solid.pattern.usual_firmness(at_rest) * np.eye(3)
        return firm

    def _searched(self, contact: Contact, moved: Array, way: Array, slope: float) -> Array | None:
        def energy(at: Array) -> float:
            pressed = contact.pushes(self.spread.places(at)).energy
            return self.spread.solid.energy(at) + pressed

        before, part = energy(moved), 1.0
        while part >= SHORTEST_PART:
            if energy(moved + part * way) <= before - SUFFICIENT_DECREASE * part * slope:
                return moved + part * way
            part *= 0.5
        return None
