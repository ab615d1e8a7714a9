"""How much more firmly a body of its material's law presses back than a linear one.

A linear body pressed to some depth is under forces f and moved by u. The other is taken to the
same depth: under forces of the same kind (the ones of a tool in proportion, those of a point that
sticks turned as they have to be) that move what is pressed as far, each by the work f would do on
it. The work along a straight way then tells the force: G times the linear one. The body is led
there quarter by quarter, each from the rest before; where it would turn aside under a tool whose
forces stay in proportion, each of the tool's nodes is led. From the half and the end G goes as ::

    G(s) = 1 + a s + b s^2,    s^2 = elastic energy of the linear press over that of the whole one

So small presses are linear, the force is the slope of an energy, and what lies deeper than was
looked at is as firm as the deepest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ..solid.free_solid import FreeSolid
from .beside_tools import beside_tools, between_tools
from .finger_load import FingerLoad, on_free_nodes, totals
from .linear_press import LinearPress, farthest_of
from .relaxation import Relaxation, Rest

Array = NDArray[np.float64]

# Shares of the depth to which the body is led one after the other, and the one beside the last at
# which firmness is told.
DEPTHS, HALF, BETWEEN = (0.25, 0.5, 0.75, 1.0), 0.5, 0.75
# Where it is taken for found: what is missed and rest, as shares of all, by energy; steps to it.
CLOSE, MOST_STEPS = 0.002, 600
# What so many steps may leave of it where it counts as found: of forces it is less, by square.
ENOUGH = 0.01
# Times as far as a linear body at most: beyond, it swings away from its tool instead of giving way.
FARTHEST = 1.25
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
class Pressed:
    """A press of a body of its law.

    Attributes
    ----------
    firmness : of it.
    energy : elastic, of the linear press, J/Pa.
    displacements : (f, 3) of the free nodes, metres; None where no rest was found so deep.
    """

    firmness: Firmness
    energy: float
    displacements: Array | None


LINEAR = Pressed(Firmness(), 0.0, None)


@dataclass(frozen=True, eq=False)
class FirmBody:
    """A body whose firmness is looked for."""

    body: SoftBody
    solid: FreeSolid
    relaxation: Relaxation

    def under(self, loads: Sequence[FingerLoad]) -> Firmness:
        """Firmness of a press whose linear forces at unit modulus are ``loads``, to its depth.

        Where the body finds no rest under forces that would be right, to the depth to which it did:
        without any the linear one.
        """
        return self.pressed(loads).firmness

    def pressed(self, loads: Sequence[FingerLoad], ahead: float = 1.0) -> Pressed:
        """The same, and the body at rest there; ``ahead``, where the press is that much deeper."""
        energy = self._energy(loads) if loads else 0.0
        if not energy > 0.0:
            return LINEAR
        if self.solid.motions is not None:
            return replace(self._lying(loads, ahead), energy=energy)
        beside, trust = self._beside(loads, ahead)
        if trust == 1.0:
            return replace(beside, energy=energy)
        led = self._led([one.times(ahead) for one in loads])
        return replace(_between(led, beside, trust) if trust else led, energy=energy)

    def on_surface(self, loads: Sequence[FingerLoad], ahead: float = 1.0) -> Pressed:
        """The same with the displacements of the free surface nodes alone."""
        found = self.pressed(loads, ahead)
        if found.displacements is None:
            return found
        return replace(found, displacements=found.displacements[self.solid.surface])

    def _energy(self, loads: Sequence[FingerLoad]) -> float:
        forces = on_free_nodes(self.solid, loads)
        return 0.5 * float((forces * self.solid.linear(forces)).sum())

    def _beside(self, loads: Sequence[FingerLoad], depth: float) -> tuple[Pressed, float]:
        """By tools that slide: of their contact with the body itself, and how far that is trusted;
        not at all where there is none.
        """
        at = partial(beside_tools, self.body, self.solid, self.relaxation, loads)
        half = at(HALF * depth)
        whole = at(depth, None if half is None else half.kept.linear / HALF)
        if whole is None and half is not None:
            further = at(BETWEEN * depth, half.kept.linear * (BETWEEN / HALF))
            whole = further and at(depth, further.kept.linear / BETWEEN)
        if whole is None:
            return LINEAR, 0.0
        told = [(whole.energy, whole.share)]
        if half is not None and half.energy < whole.energy:
            told.insert(0, (half.energy, half.share))
        found = Pressed(_through(told), whole.energy, whole.kept.displacements)
        return found, whole.trust

    def _lying(self, loads: Sequence[FingerLoad], ahead: float) -> Pressed:
        """A body that nothing holds, between all that touches it: by its contact with them where
        they are, and on the way there, and where that is not trusted, by all of their forces.
        """
        led = self._led([one.times(ahead) for one in loads])
        known = led.firmness
        energy = self._energy(loads)
        found = between_tools(self.body, self.solid, self.relaxation, loads)
        if found is None:
            return led
        # What its weight alone presses answers with that, however firm it is.
        sums = totals(loads)
        weight = float(np.linalg.norm(sums.sum(axis=0)) / np.linalg.norm(sums, axis=1).sum())
        share = (1.0 - weight) * found.share + weight * known.at(energy)
        half = HALF * HALF * energy
        through = _through([(half, known.at(half)), (energy, share)])
        beside = Pressed(through, energy, found.kept.displacements)
        return beside if found.trust == 1.0 else _between(led, beside, found.trust)

    def _led(self, loads: Sequence[FingerLoad]) -> Pressed:
        """By forces that lead it to where a linear body would be."""
        whole = LinearPress.of(self.solid, loads)
        known, rest = self._led_by(whole)
        if max(known) < DEPTHS[-1] and not all(load.sticks for load in loads):
            others, other_rest = self._led_by(LinearPress.of(self.solid, loads, by_nodes=True))
            if max(others) > max(known):
                known, rest = others, other_rest
        return self._told(whole, known, rest)

    def _told(self, whole: LinearPress, known: dict[float, float], rest: Rest | None) -> Pressed:
        """What G at some shares of the depth, and the rest at the deepest, tell of a press."""
        deepest = max(known)
        is_whole = deepest == DEPTHS[-1]
        told = [
            (depth * depth * whole.energy, known[depth])
            for depth in sorted({min(HALF, deepest), deepest} - {0.0})
        ]
        moved = whole.met(self.solid, rest.displacements) if rest and is_whole else None
        return Pressed(replace(_through(told), is_whole=is_whole), whole.energy, moved)

    def _led_by(self, press: LinearPress) -> tuple[dict[float, float], Rest | None]:
        """G at all shares of the depth to which there is a rest, and the deepest."""
        known, rest = {0.0: 1.0}, None
        before = 0.0
        for depth in DEPTHS:
            ways = depth * press.ways
            further = self.relaxation.led(press.patterns, ways, CLOSE, MOST_STEPS, rest)
            share = float(further.forces @ press.ways) / (depth * press.work)
            # A tool's force that falls is of a body that has turned aside, where a tool cannot go;
            # and so is a way far beyond the linear one, as of a wing that swings.
            swings = farthest_of(further.displacements) > FARTHEST * depth * press.farthest
            aside = press.is_of_tools and (depth * share < before or swings)
            if further.left > ENOUGH or aside:
                break
            rest, before = further, depth * share
            known[depth] = min(max(share, LEAST), MOST)
        return known, rest


def _between(one: Pressed, other: Pressed, share: float) -> Pressed:
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


def _through(known: Sequence[tuple[float, float]]) -> Firmness:
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
