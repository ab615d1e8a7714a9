"""How firmly a body presses back over the depth, and what was found of a press."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .beside.kept_out import Kept
from .relaxation import Rest

Array = NDArray[np.float64]

# Bounds of what is believed.
LEAST, MOST = 0.1, 30.0


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

    def times(self, share: float) -> Firmness:
        """The same to the same depth, where ``share`` of the energy is held so deep."""
        return replace(
            self,
            root=self.root / math.sqrt(share),
            whole=self.whole / share,
            reach=self.reach * share,
        )

    @property
    def deepest(self) -> float:
        """G at the reach, and beyond."""
        return self.at(self.reach)

    @property
    def mean(self) -> float:
        """The mean of G from none to the reach: what is held there over the linear energy."""
        known = self.reach
        return 1.0 + 2.0 / 3.0 * self.root * math.sqrt(known) + 0.5 * self.whole * known


@dataclass(frozen=True, eq=False)
class Found:
    """What was found of a press of a body that nothing holds; one that is near goes on from it.

    Attributes
    ----------
    kept : where tools kept it out.
    rest : to which its forces led it.
    curve : how firm it was on the way there.
    """

    kept: Kept | None = None
    rest: Rest | None = None
    curve: Firmness | None = None


@dataclass(frozen=True, eq=False)
class Pressed:
    """A press of a body of its law.

    Attributes
    ----------
    firmness : of it.
    energy : elastic, of the linear press, J/Pa.
    displacements : (f, 3) of the free nodes, metres; None where no rest was found so deep.
    found : what was found on the way.
    """

    firmness: Firmness
    energy: float
    displacements: Array | None
    found: Found | None = None


LINEAR = Pressed(Firmness(), 0.0, None)


def blended(one: Pressed, other: Pressed, share: float) -> Pressed:
    """Of two answers about a press, so much of the other; all of it where the first is none."""
    if one.displacements is None or other.displacements is None:
        return other

    def at_reach(of: Firmness) -> Array:
        return np.array([of.root * math.sqrt(of.reach), of.whole * of.reach, of.reach])

    parts = (1.0 - share) * at_reach(one.firmness) + share * at_reach(other.firmness)
    root, whole, reach = parts.tolist()
    return Pressed(
        Firmness(root / math.sqrt(reach), whole / reach, reach),
        other.energy,
        (1.0 - share) * one.displacements + share * other.displacements,
    )


def through(known: Sequence[tuple[float, float]]) -> Firmness:
    """The parabola over the depth through none, one or two energies with the firmness there,
    ascending, and 1 at no energy.
    """
    if not known:
        return Firmness()
    reach = known[-1][0]
    powers = [0.5, 1.0][: len(known)]
    rows = [[(energy / reach) ** power for power in powers] for energy, _ in known]
    found = np.linalg.solve(rows, [min(max(share, LEAST), MOST) - 1.0 for _, share in known])
    root, whole = [*found, 0.0][:2]
    return Firmness(root / math.sqrt(reach), whole / reach, reach)
