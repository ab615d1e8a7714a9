"""How much more firmly a body of its material's law presses back than a linear one.

A linear body pressed to some depth is under forces f and moved by u. The other is taken to the
same depth: under forces of the same kind (the ones of a tool in proportion, those of a point that
sticks turned as they have to be) that move what is pressed as far, each by the work f would do on
it. The work along a straight way then tells the force: G times the linear one. The body is led
there quarter by quarter, each from the rest before; where it would turn aside under a tool whose
forces stay in proportion, each of the tool's nodes is led. What is told is G at each of these
depths. So small presses are linear, and the force is the slope of an energy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ..solid.free_solid import FreeSolid
from ..solid.held_solid import led_to
from .beside.beside_tools import Beside, beside_tools, between_tools
from .finger_load import FingerLoad, joined, let_go, on_free_nodes, totals
from .linear_press import LinearPress
from .pressed import LINEAR, Found, Pressed, blended, through
from .relaxation import Relaxation, Rest

Array = NDArray[np.float64]

# Shares of the depth at which a tool's contact is told beside the whole.
HALF, BETWEEN = 0.5, 0.75
# Where it is taken for found: what is missed and rest, as shares of all, by energy.
CLOSE = 0.001


@dataclass(frozen=True)
class _Leading:
    """To which shares of the depth a body is led one after the other, in how many steps at most;
    what these may leave of it where it counts as found: of forces it is less, by square. Whether
    each of a tool's nodes is, where its forces in proportion do not.
    """

    depths: tuple[float, ...] = (0.25, 0.5, 0.75, 1.0)
    steps: int = 1000
    enough: float = 0.01
    by_nodes: bool = True


USUALLY = _Leading()
# Of a press that goes on there is little time for looks.
ON_WAY = _Leading((0.5, 1.0), 60, by_nodes=False)
# Nodes that a hand holds one by one: where it does not do Newton's method goes on.
HELD = _Leading(steps=200, enough=CLOSE)


@dataclass(frozen=True, eq=False)
class FirmBody:
    """A body whose firmness is looked for."""

    body: SoftBody
    solid: FreeSolid
    relaxation: Relaxation

    def pressed(
        self, loads: Sequence[FingerLoad], ahead: float = 1.0, before: Found | None = None
    ) -> Pressed:
        """A press whose linear forces at unit modulus are ``loads``: firmness to its depth, and the
        body at rest there.

        Where the body finds no rest under forces that would be right, to the depth to which it did:
        without any the linear one.

        Parameters
        ----------
        ahead : where it is that much deeper; beyond 1 of one that goes on, for whom there is little
            time: from ``before``, and at few depths.
        before : of a press by the same tools at the same places.
        """
        energy = self._energy(loads) if loads else 0.0
        if not energy > 0.0:
            return LINEAR
        if self.solid.motions is not None:
            return replace(self._lying(loads, ahead, before or Found()), energy=energy)
        if ahead > 1.0:
            near = None if before is None else before.taken_to(ahead * ahead * energy)
            return replace(self._on_way(loads, ahead, near), energy=energy)
        beside, trust = self._beside(loads)
        led = self._led(loads) if trust < 1.0 else LINEAR
        return replace(blended(led, beside, trust) if trust else led, energy=energy)

    def _energy(self, loads: Sequence[FingerLoad]) -> float:
        forces = on_free_nodes(self.solid, loads)
        return 0.5 * float((forces * self.solid.linear(forces)).sum())

    def _on_way(self, loads: Sequence[FingerLoad], ahead: float, near: Found | None) -> Pressed:
        """Of a press that goes on and does not wait: at few depths, from one that is near."""
        start = None if near is None or near.kept is None else near.kept.linear
        found = beside_tools(self.body, self.solid, self.relaxation, loads, ahead, start)
        if found is not None and found.trust == 1.0:
            return _told_beside([found])
        deeper = [one.times(ahead) for one in loads]
        led = self._led(deeper, near, ON_WAY)
        if found is None:
            return led
        both = replace(led.found or Found(), kept=found.kept)
        return replace(blended(led, _told_beside([found]), found.trust), found=both)

    def _beside(self, loads: Sequence[FingerLoad]) -> tuple[Pressed, float]:
        """By tools that slide: of their contact with the body itself, and how far that is trusted;
        not at all where there is none.
        """
        at = partial(beside_tools, self.body, self.solid, self.relaxation, loads)
        half = at(HALF)
        whole = at(1.0, None if half is None else half.kept.linear / HALF)
        if whole is None and half is not None:
            further = at(BETWEEN, half.kept.linear * (BETWEEN / HALF))
            whole = further and at(1.0, further.kept.linear / BETWEEN)
        if whole is None:
            return LINEAR, 0.0
        found = [half, whole] if half and half.energy < whole.energy else [whole]
        return _told_beside(found), whole.trust

    def _lying(self, loads: Sequence[FingerLoad], ahead: float, before: Found) -> Pressed:
        """A body that nothing holds, between all that touches it: by its contact with them where
        they are, and on the way there, and where that is not trusted, by all of their forces.
        """
        kept_out = between_tools(self.body, self.solid, self.relaxation, loads, before.kept)
        is_known = kept_out is not None and kept_out.trust == 1.0
        if is_known and before.curve is not None and not before.curve.is_whole:
            # It would be led as far as before.
            led = Pressed(before.curve, before.curve.reach, None, before)
        else:
            deeper = [one.times(ahead) for one in loads]
            led = self._led(deeper, before, replace(USUALLY, by_nodes=not is_known))
        known = led.firmness
        kept = before.kept if kept_out is None else kept_out.kept
        found = replace(led.found or before, kept=kept)
        if kept_out is None or kept_out.trust == 0.0:
            return replace(led, found=found)
        # What its weight alone presses answers with that, however firm it is.
        sums, only = totals(loads), let_go(loads)
        left = sums.sum(axis=0) if only is None else only * (sums.sum(axis=0) @ only)
        weight = float(np.linalg.norm(left) / np.linalg.norm(sums, axis=1).sum())
        energy = kept_out.energy
        share = (1.0 - weight) * kept_out.share + weight * known.at(energy)
        way = [depth * depth * energy for depth in USUALLY.depths if depth <= HALF]
        curve = through([*((there, known.at(there)) for there in way), (energy, share)])
        beside = Pressed(curve, energy, kept_out.kept.displacements)
        return replace(blended(led, beside, kept_out.trust), found=found)

    def _led(
        self,
        loads: Sequence[FingerLoad],
        before: Found | None = None,
        leading: _Leading | None = None,
    ) -> Pressed:
        """By forces that lead it to where a linear body would be, as usually or otherwise."""
        whole = LinearPress.of(self.solid, loads)
        are_held = self._are_held(loads)
        leading = HELD if are_held else leading or USUALLY
        goes_on = self._led_on(whole, before, leading) if before is not None else None
        known, rest = goes_on or self._led_by(whole, leading)
        all_stick = all(load.sticks for load in loads)
        if leading.by_nodes and max(known) < 1.0 and not all_stick:
            each = LinearPress.of(self.solid, loads, by_nodes=True)
            others, other_rest = self._led_by(each, leading)
            if max(others) > max(known):
                return self._told(whole, others, _displacements(other_rest))
        moved = _displacements(rest)
        if max(known) < 1.0 and are_held:
            moved, rest = self._held(whole, loads, known, moved), None
        told = self._told(whole, known, moved)
        on = rest if told.firmness.is_whole else None
        return replace(told, found=Found(None, on, told.firmness))

    def _are_held(self, loads: Sequence[FingerLoad]) -> bool:
        """Whether a hand holds nodes of a pinned body, each by itself."""
        each = all(load.sticks and len(load.nodes) == 1 for load in loads)
        return each and self.solid.motions is None

    def _held(
        self,
        whole: LinearPress,
        loads: Sequence[FingerLoad],
        known: dict[float, float],
        moved: Array | None,
    ) -> Array:
        """The body as far as its held nodes can be led from the deepest known, which is told."""
        begin, start = max(known), np.zeros_like(whole.linear) if moved is None else moved
        nodes = np.searchsorted(self.solid.free, np.setdiff1d(joined(loads)[0], self.body.fixed))
        way = whole.linear[nodes]
        depth, moved = led_to(self.solid, nodes, way, begin, start)
        if depth > begin:
            forces = self.solid.forces(moved)[nodes]
            work = depth * float((whole.forces[nodes] * way).sum())
            known[depth] = float((forces * way).sum()) / work
        return moved

    def _told(self, whole: LinearPress, known: dict[float, float], at: Array | None) -> Pressed:
        """What G at some shares of the depth, and the body at the deepest, tell of a press."""
        deepest = max(known)
        is_whole = deepest == 1.0
        told = [
            (depth * depth * whole.energy, known[depth]) for depth in sorted(set(known) - {0.0})
        ]
        moved = None if at is None or not is_whole else whole.met(self.solid, at)
        return Pressed(replace(through(told), is_whole=is_whole), whole.energy, moved)

    def _led_on(
        self, press: LinearPress, before: Found, leading: _Leading
    ) -> tuple[dict[float, float], Rest | None] | None:
        """As :meth:`_led_by`, from the rest of one that is near; None where that does not do."""
        if before.rest is None or before.curve is None:
            return None
        rest = self.relaxation.led(press.patterns, press.ways, CLOSE, leading.steps, before.rest)
        if rest.left > leading.enough or press.swings(rest.displacements, 1.0):
            return None
        known = {1.0: float(rest.forces @ press.ways) / press.work}
        if self.solid.motions is not None:
            known[HALF] = before.curve.at(HALF * HALF * press.energy)
        return known, rest

    def _led_by(
        self, press: LinearPress, leading: _Leading
    ) -> tuple[dict[float, float], Rest | None]:
        """G at all shares of the depth to which there is a rest, and that at the deepest."""
        known, rest = {0.0: 1.0}, None
        before = 0.0
        for depth in leading.depths:
            ways = depth * press.ways
            further = self.relaxation.led(press.patterns, ways, CLOSE, leading.steps, rest)
            share = float(further.forces @ press.ways) / (depth * press.work)
            # A tool's force that falls is of a body that has turned aside, where a tool cannot go.
            falls = press.is_of_tools and depth * share < before
            if further.left > leading.enough or falls or press.swings(further.displacements, depth):
                break
            rest, before = further, depth * share
            known[depth] = share
        return known, rest


def _told_beside(found: Sequence[Beside]) -> Pressed:
    """What a body beside tools tells of a press, at depths of which the last is its own."""
    curve, whole = through([(one.energy, one.share) for one in found]), found[-1]
    known = Found(whole.kept, None, curve)
    return Pressed(curve, whole.energy, whole.kept.displacements, known)


def _displacements(rest: Rest | None) -> Array | None:
    return None if rest is None else rest.displacements
