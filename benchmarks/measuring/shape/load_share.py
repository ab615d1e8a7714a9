"""Tried models of how much more a tool presses a body of its material's law than a linear one.

A tool that presses the linear body with forces f and moves it by u is taken to press the other with
``G f``, G such that this does the same work on the way, f . v(G f) = f . u, with v the displacement
under forces by the law. What is tried is where v comes from.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from palpate.core.shape.rotation_strain.relaxation import Relaxation
from palpate.core.shape.solid.free_solid import FreeSolid

Array = NDArray[np.float64]
# Takes a share G of a load to displacements (f, 3) of the free nodes; None where no rest is found.
Moved = Callable[[float], Array | None]

# Work that is missed, as a share of the wanted.
CLOSE = 2e-3
MOST_TRIES = 12
# The share changes by no more at once; the change is halved where no rest is found.
LARGEST_CHANGE = 0.3
# Steps towards rest, and what may be left: what the unbalanced forces would move, in energy.
MOST_STEPS = 100
REST = 0.002
# Share of the displacement at which its derivative is taken, and of the coefficients theirs.
LITTLE = 1e-3
FOUND = 1e-5


def load_share(forces: Array, wanted: float, moved: Moved) -> float:
    """G, by secants, so that G times ``forces`` (f, 3) does the work ``wanted``; nan if none."""
    share, work, slope, change = 0.0, 0.0, wanted, 1.0
    for _ in range(MOST_TRIES):
        there = moved(share + change)
        if there is None:
            change *= 0.5
            continue
        before, work = work, float((forces * there).sum())
        slope = max((work - before) / change, 0.2 * wanted)
        share += change
        if abs(work - wanted) <= CLOSE * wanted:
            return share
        change = float(np.clip((wanted - work) / slope, -LARGEST_CHANGE, LARGEST_CHANGE))
    return float("nan")


@dataclass(frozen=True, eq=False)
class Relaxed:
    """The shape *rotation-strain* of the body's own nodes, relaxed until it rests."""

    relaxation: Relaxation
    forces: Array

    def __call__(self, share: float) -> Array | None:
        """Displacements (f, 3) under a share of the load."""
        rest = self.relaxation.at_rest(share * self.forces, REST, MOST_STEPS)
        return rest.displacements if rest.left <= REST else None


@dataclass(frozen=True, eq=False)
class Span:
    """The body's linear response to a load and the derivative of that by the load: all it can do.

    Attributes
    ----------
    solid : whose whole energy counts.
    forces : (f, 3).
    modes : (2, f, 3): K^-1 f, and half the second derivative of the displacement by the load.
    """

    solid: FreeSolid
    forces: Array
    modes: Array

    @classmethod
    def of(cls, solid: FreeSolid, forces: Array) -> Span:
        """Of a load (f, 3) at unit modulus."""
        first = solid.linear(forces)
        h = LITTLE * float(np.ptp(solid.positions)) / float(np.abs(first).max())
        bent = (solid.forces(h * first) + solid.forces(-h * first)) / (2.0 * h**2)
        return cls(solid, forces, np.stack([first, -solid.linear(bent)]))

    def __call__(self, share: float) -> Array | None:
        """Displacements (f, 3) of least energy in the span under a share of the load."""
        at = np.array([share, share**2])
        for _ in range(4 * MOST_TRIES):
            left = self._unbalanced(at, share)
            slope = np.empty((2, 2))
            for column, h in enumerate(LITTLE * np.eye(2)):
                slope[:, column] = (self._unbalanced(at + h, share) - left) / LITTLE
            change = np.linalg.solve(slope, left)
            largest = float(np.abs(change).max())
            at = at - change * min(1.0, LARGEST_CHANGE / max(largest, FOUND))
            if largest <= FOUND:
                moved: Array = np.einsum("m,mfi->fi", at, self.modes)
                return moved
        return None

    def _unbalanced(self, at: Array, share: float) -> Array:
        held = self.solid.forces(np.einsum("m,mfi->fi", at, self.modes)) - share * self.forces
        unbalanced: Array = np.einsum("mfi,fi->m", self.modes, held)
        return unbalanced
