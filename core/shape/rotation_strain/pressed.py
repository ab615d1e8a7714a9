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

# Of presses that are at most so many times as deep, or as shallow, one goes on from the other.
NEAR = 4.0
# Bounds of what is believed.
LEAST, MOST = 0.1, 30.0
# Depths over that of the reach: from where to there the slope is told, and how far it is followed.
BEFORE, FARTHER = 0.75, (1.15, 1.3, 1.5)


@dataclass(frozen=True)
class Firmness:
    """Firmness G as a function of the elastic energy W of the linear press, at unit modulus: 1 at
    none, straight between those known over the depth, the root of W.

    Attributes
    ----------
    energies, shares : G at some W, J/Pa, ascending.
    is_whole : whether it was found to the whole depth.
    """

    energies: tuple[float, ...] = ()
    shares: tuple[float, ...] = ()
    is_whole: bool = True

    def at(self, energy: float) -> float:
        """G of a linear press that holds ``energy``, J/Pa; beyond those known that of the last."""
        depths = np.sqrt([0.0, *self.energies])
        return float(np.interp(math.sqrt(max(energy, 0.0)), depths, [1.0, *self.shares]))

    def times(self, share: float) -> Firmness:
        """The same to the same depth, where ``share`` of the energy is held so deep."""
        return replace(self, energies=tuple(share * energy for energy in self.energies))

    def going_on(self) -> Firmness:
        """The same, and somewhat farther half as steeply as before: for fingers that go deeper."""
        reach, deepest = self.reach, self.deepest
        if not reach > 0.0:
            return self
        slope = 0.5 * (deepest - self.at(BEFORE * BEFORE * reach)) / (1.0 - BEFORE)
        beyond = [(far * far * reach, deepest + slope * (1.0 - 1.0 / far)) for far in FARTHER]
        return through([*zip(self.energies, self.shares, strict=True), *beyond])

    @property
    def reach(self) -> float:
        """W of the deepest known, J/Pa."""
        return max(self.energies, default=0.0)

    @property
    def deepest(self) -> float:
        """G there, and beyond."""
        return self.shares[-1] if self.shares else 1.0

    @property
    def mean(self) -> float:
        """The mean of G from none to the reach: what is held there over the linear energy."""
        if not self.shares:
            return 1.0
        depths = np.sqrt([0.0, *self.energies])
        shares = np.array([1.0, *self.shares])
        # Simpson's rule, exact for G s of a G that is straight.
        middle = (depths[1:] + depths[:-1]) * (shares[1:] + shares[:-1])
        ends = depths * shares
        sums = np.diff(depths) * (ends[1:] + ends[:-1] + middle) / 6.0
        return float(2.0 * sums.sum() / self.reach)


@dataclass(frozen=True, eq=False)
class Found:
    """What was found of a press; one that is near goes on from it.

    Attributes
    ----------
    kept : where tools kept it out.
    rest : to which its forces led it.
    curve : how firm it was on the way there.
    """

    kept: Kept | None = None
    rest: Rest | None = None
    curve: Firmness | None = None

    def taken_to(self, energy: float) -> Found | None:
        """In proportion to where a press holds ``energy``, J/Pa; None where that is not near."""
        reach = 0.0 if self.curve is None else self.curve.reach
        if not reach / NEAR**2 <= energy <= reach * NEAR**2:
            return None
        deeper = math.sqrt(energy / reach)
        kept = self.kept and replace(self.kept, linear=deeper * self.kept.linear)
        return replace(self, kept=kept)


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

    before, found = one.firmness, other.firmness
    reach = (1.0 - share) * before.reach + share * found.reach
    parts = [energy / found.reach for energy in found.energies]
    shares = [
        (1.0 - share) * before.at(part * before.reach) + share * found.at(part * found.reach)
        for part in parts
    ]
    return Pressed(
        Firmness(tuple(part * reach for part in parts), tuple(shares)),
        other.energy,
        (1.0 - share) * one.displacements + share * other.displacements,
    )


def through(known: Sequence[tuple[float, float]]) -> Firmness:
    """Through energies, ascending, with the firmness there, as far as that is believed."""
    energies = tuple(energy for energy, _ in known)
    return Firmness(energies, tuple(min(max(share, LEAST), MOST) for _, share in known))
