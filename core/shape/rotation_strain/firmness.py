"""How much more firmly a body of its material's law presses back than a linear one.

A linear body pressed to some depth is under forces f and moved by u. The other is taken to the
same depth: under forces of the same kind (the ones of a tool in proportion, those of a point that
sticks turned as they have to be) that move what is pressed as far, each by the work f would do on
it. The work along a straight way then tells the force: G times the linear one. It is found at half
the depth and at the whole, and between goes as ::

    G(s) = 1 + a s + b s^2,    s^2 = elastic energy of the linear press over that of the whole one

So small presses are linear, the force is the slope of an energy, and what lies deeper than was
looked at is as firm as the deepest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..solid.free_solid import FreeSolid
from .finger_load import FingerLoad
from .relaxation import Relaxation

Array = NDArray[np.float64]

# Shares of the depth at which it is looked for; where nothing is found at the last, between.
DEPTHS, BETWEEN = (0.5, 1.0), 0.75
# Where it is taken for found: work that is missed, as a share of all; and rest.
CLOSE, REST = 0.004, 0.002
# Steps towards rest, and tries of forces.
MOST_STEPS, MOST_TRIES = 100, 16
# Forces change by no more than this share of the linear ones in a try.
LARGEST_CHANGE = 0.4
# Bounds of what is believed.
LEAST, MOST = 0.3, 3.0


@dataclass(frozen=True)
class Firmness:
    """Firmness as a function of the elastic energy W of the linear press, at unit modulus.

    Attributes
    ----------
    root, whole : G is 1 + root sqrt(W) + whole W, W in J/Pa.
    reach : W beyond which G stays.
    is_whole : whether it was found to the whole depth.
    """

    root: float = 0.0
    whole: float = 0.0
    reach: float = 0.0
    is_whole: bool = True

    def at(self, energy: float) -> float:
        """G of a linear press that holds ``energy``, J/Pa."""
        known = min(max(energy, 0.0), self.reach)
        return min(max(1.0 + self.root * math.sqrt(known) + self.whole * known, LEAST), MOST)

    @property
    def deepest(self) -> float:
        """G at the reach, and beyond."""
        return self.at(self.reach)


@dataclass(frozen=True, eq=False)
class FirmBody:
    """A body whose firmness is looked for."""

    solid: FreeSolid
    relaxation: Relaxation

    def under(self, loads: Sequence[FingerLoad]) -> Firmness:
        """Firmness of a press whose linear forces at unit modulus are ``loads``, to its depth.

        Where the body finds no rest under forces that would be right, to the depth to which it did:
        without any the linear one.
        """
        found = _Press.of(self, loads)
        if found is None or found.energy <= 0.0:
            return Firmness()
        known = [(0.0, 1.0)]
        for depth in (*DEPTHS, BETWEEN):
            share = found.to(depth, known[-1][1])
            if share is not None:
                known.append((depth, min(max(share, LEAST), MOST)))
            if known[-1][0] == DEPTHS[-1] or len(known) == 1:
                break
        return _through(known, found.energy)


def _through(known: Sequence[tuple[float, float]], energy: float) -> Firmness:
    """The parabola through firmness at shares of the depth, the first 1 at none."""
    depth, last = known[-1]
    if depth == 0.0:
        return Firmness(is_whole=False)
    if len(known) == 2:
        slope, bend = (last - 1.0) / depth, 0.0
    else:
        rows = [[share, share * share] for share, _ in known[1:]]
        slope, bend = np.linalg.solve(rows, [firm - 1.0 for _, firm in known[1:]])
    reach = depth * depth * energy
    return Firmness(slope / math.sqrt(energy), bend / energy, reach, depth == DEPTHS[-1])


@dataclass(eq=False)
class _Press:
    """The forces that move what is pressed as far as the linear ones do.

    Attributes
    ----------
    patterns : (p, f, 3), what forces are made of.
    linear : (p,), of how much of each the linear ones are.
    ways : (p,), work of each on the linear displacement.
    compliance : (p, p), work of each on the linear displacement under another.
    """

    body: FirmBody
    patterns: Array
    linear: Array
    ways: Array
    compliance: Array

    @classmethod
    def of(cls, body: FirmBody, loads: Sequence[FingerLoad]) -> _Press | None:
        patterns, linear = [], []
        for load in loads:
            whole = body.solid.on_free_nodes(load.nodes, load.forces)
            if not whole.any():
                continue
            if not load.sticks:
                patterns.append(whole)
                linear.append(1.0)
                continue
            for axis, size in enumerate(load.forces.sum(axis=0)):
                each = load.weights[:, None] * np.eye(3)[axis]
                patterns.append(body.solid.on_free_nodes(load.nodes, each))
                linear.append(size)
        if not patterns:
            return None
        made = np.stack(patterns)
        moved = np.stack([body.solid.linear(one) for one in made])
        compliance = np.einsum("pfi,qfi->pq", made, moved)
        given = np.array(linear)
        return cls(body, made, given, compliance @ given, compliance)

    @property
    def energy(self) -> float:
        """Elastic energy of the linear press, J/Pa."""
        return 0.5 * float(self.linear @ self.ways)

    def to(self, depth: float, guess: float) -> float | None:
        """G at a share of the depth; None where no forces that rest were found."""
        wanted, forces = depth * self.ways, guess * depth * self.linear
        inverse = np.linalg.pinv(self.compliance, rcond=1e-9, hermitian=True)
        response = np.asarray(inverse, dtype=np.float64)
        scale = math.sqrt(float(wanted @ response @ wanted))
        last: tuple[Array, Array] | None = None
        for _ in range(MOST_TRIES):
            load = np.einsum("p,pfi->fi", forces, self.patterns)
            rest = self.body.relaxation.at_rest(load, REST, MOST_STEPS)
            if rest.left > 5.0 * REST:
                return None
            missed: Array = wanted - np.einsum("pfi,fi->p", self.patterns, rest.displacements)
            if last is not None:
                response = _learnt(response, forces - last[0], last[1] - missed)
            if np.sqrt(abs(missed @ response @ missed)) <= CLOSE * scale:
                return float(forces @ self.ways) / (depth * float(self.linear @ self.ways))
            last = forces, missed
            change = response @ missed
            size = math.sqrt(float(change @ self.compliance @ change))
            forces = forces + change * min(1.0, LARGEST_CHANGE * scale / max(size, 1e-300))
        return None


def _learnt(response: Array, change: Array, moved: Array) -> Array:
    """Broyden's update of forces per way by a change of forces that ``moved`` places so far."""
    through = response @ moved
    along = float(change @ through)
    if abs(along) <= 1e-3 * float(np.linalg.norm(change) * np.linalg.norm(through)):
        return response
    learnt: Array = response + np.outer((change - through) / along, change @ response)
    return learnt
