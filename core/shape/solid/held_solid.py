"""Nodes that a hand leads somewhere, held there by stiff springs: rests by Newton's method."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .free_solid import FreeSolid
from .newton import equilibrium_near
from .solid import Solid

Array = NDArray[np.float64]

# Times as firm as nodes are at rest: so that what holds them gives way by nothing that is seen.
FIRM = 1e5
# Forces that are not balanced, as a share of the springs', and the shortest part of a way.
BALANCED, SHORTEST = 1e-10, 1 / 16


@dataclass(frozen=True, eq=False)
class HeldSolid(Solid):
    """A solid with springs from nodes ``held`` (k,) to their places at rest, ``firmness`` N/m at
    1 Pa each.
    """

    held: NDArray[np.int64]
    firmness: float

    def energy(self, displacements: Array) -> float:
        """As of :class:`Solid`, and of the springs."""
        sprung = 0.5 * self.firmness * float(np.square(displacements[self.held]).sum())
        return super().energy(displacements) + sprung

    def forces(self, displacements: Array) -> Array:
        """As of :class:`Solid`, and of the springs."""
        found = super().forces(displacements)
        found[self.held] += self.firmness * displacements[self.held]
        return found

    def tangent_blocks(self, displacements: Array, *, convex: bool = False) -> Array:
        """As of :class:`Solid`, and of the springs."""
        blocks = super().tangent_blocks(displacements, convex=convex)
        blocks[self.pattern.own[self.held]] += self.firmness * np.eye(3)
        return blocks


def led_to(
    body: FreeSolid, nodes: NDArray[np.int64], way: Array, begin: float, start: Array
) -> tuple[float, Array]:
    """How far ``nodes`` (k,) of the free ones can be led along ``way`` (k, 3), as a share of it,
    from a share ``begin`` where the body is at ``start`` (f, 3); and its displacements there.
    """
    inner = body.solid
    at_rest = inner.tangent_blocks(np.zeros((body.node_count, 3)))
    firmness = FIRM * inner.pattern.usual_firmness(at_rest)
    held = replace(body, solid=HeldSolid(inner.terms, inner.node_count, inner.law, nodes, firmness))
    load = np.zeros((body.node_count, 3))
    load[nodes] = firmness * way
    part = 1.0 - begin
    while begin < 1.0 and part >= SHORTEST:
        goal = min(begin + part, 1.0)
        found = equilibrium_near(held, goal * load, start, BALANCED)
        if found is None:
            part *= 0.5
        else:
            begin, start = goal, found.displacements
    return begin, start
