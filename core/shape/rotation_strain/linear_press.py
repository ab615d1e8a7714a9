"""What a linear body is under in a press, for a body of another law to be led as far."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..solid.free_solid import FreeSolid
from .finger_load import FingerLoad, let_go, on_free_nodes
from .lying import met
from .relaxation import Patterns

Array = NDArray[np.float64]

# What carries less than this share of a tool's heaviest node is not led by itself.
LIGHTEST = 1e-3
# Times as far as a linear body at most: beyond, it swings away from its tool instead of giving way.
FARTHEST = 1.25


@dataclass(frozen=True, eq=False)
class LinearPress:
    """The linear press.

    Attributes
    ----------
    patterns : what forces are made of.
    ways : (p,), work of each on the linear displacement.
    work : of as much of each as leads a linear body there, J/Pa.
    energy : elastic, J/Pa.
    farthest : way of a node, metres.
    is_of_tools : and of no point.
    forces, linear : (f, 3), all of them, and the linear displacement.
    only : the direction (3,) in which alone a hand lets the body go.
    """

    patterns: Patterns
    ways: Array
    work: float
    energy: float
    farthest: float
    is_of_tools: bool
    forces: Array
    linear: Array
    only: Array | None

    @classmethod
    def of(
        cls, solid: FreeSolid, loads: Sequence[FingerLoad], by_nodes: bool = False
    ) -> LinearPress:
        """Of these loads; ``by_nodes``: each node of a tool's is led by itself. What nothing holds
        is led by all of them at once.
        """
        patterns: list[Array] = []

        def add(nodes: NDArray[np.int64], forces: Array) -> None:
            whole = solid.on_free_nodes(nodes, forces)
            if whole.any():
                patterns.append(whole)

        are_together = solid.motions is not None and not by_nodes
        if are_together:
            patterns.append(on_free_nodes(solid, loads))
        for load in () if are_together else loads:
            if load.sticks:
                for axis in np.eye(3):
                    add(load.nodes, load.weights[:, None] * axis)
            elif by_nodes:
                sizes = np.linalg.norm(load.forces, axis=1)
                for one in np.flatnonzero(sizes > LIGHTEST * sizes.max(initial=0.0)):
                    add(load.nodes[[one]], load.forces[[one]])
            else:
                add(load.nodes, load.forces)
        made = Patterns(np.stack(patterns), np.stack([solid.linear(one) for one in patterns]))
        whole = on_free_nodes(solid, loads)
        linear = solid.linear(whole)
        ways: Array = np.einsum("pfi,fi->p", made.forces, linear)
        work, energy = float(ways @ made.response @ ways), 0.5 * float((whole * linear).sum())
        is_of_tools = not any(load.sticks for load in loads)
        far, only = _farthest(linear), let_go(loads)
        return cls(made, ways, work, energy, far, is_of_tools, whole, linear, only)

    def met(self, solid: FreeSolid, moved: Array) -> Array:
        """The body at rest where what touches it is; see :func:`.lying.met`."""
        if solid.motions is None:
            return moved
        return met(solid.motions.of_nodes, moved, self.linear, self.forces, self.only)

    def swings(self, moved: Array, depth: float) -> bool:
        """Whether a body led by tools to a share ``depth`` goes far beyond that, as a wing does."""
        return self.is_of_tools and _farthest(moved) > FARTHEST * depth * self.farthest


def _farthest(displacements: Array) -> float:
    """How far a node goes at most, metres."""
    return float(np.linalg.norm(displacements, axis=1).max())
