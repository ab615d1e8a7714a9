"""Axis with Coulomb friction, with exact instants of reversal and true sticking.

    m x'' = load - k x - c x' - f_c sign(x')        while it moves
    |load - k x| <= f_c                             while it sticks

Between reversals friction is constant and the motion is its Taylor series, summed to the last
digit, so that long steps neither creep nor chatter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

_TERMS = 20
_MOST_PER_PIECE = 0.7
"""Length of a piece times its fastest rate at which the series converges to the last digit."""
_MOST_REVERSALS = 8
_BISECTIONS = 60
_MOST_PIECES = 50

GAUSS = (
    (0.5 - math.sqrt(0.15), 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.5 + math.sqrt(0.15), 5.0 / 18.0),
)
"""Gauss-Legendre places and weights on [0, 1], exact to the fifth power."""


@dataclass(frozen=True)
class Slid:
    """State after a step: position, velocity, integral of v^2, friction path."""

    position: float
    velocity: float
    velocity_squared: float
    way: float


@dataclass(frozen=True)
class Slider:
    """Axis of a mass (kg), total stiffness (N/m), damping (N s/m) and Coulomb friction (N)."""

    mass: float
    stiffness: float
    damping: float
    coulomb: float

    def pieces(self, seconds: float) -> int:
        """Number of pieces of a step, so that each series converges."""
        rate = self.damping / self.mass + math.sqrt(self.stiffness / self.mass)
        return max(1, math.ceil(seconds * rate / _MOST_PER_PIECE))

    def can_step(self, seconds: float) -> bool:
        """Whether a step of this length takes bounded time to compute."""
        return self.pieces(seconds) <= _MOST_PIECES

    def step(self, position: float, velocity: float, load: float, seconds: float) -> Slid:
        """Step of `seconds` under a constant load, N."""
        pieces = self.pieces(seconds)
        here = Slid(position, velocity, 0.0, 0.0)
        for _ in range(pieces):
            here = self._piece(here, load, seconds / pieces)
        return here

    def _piece(self, here: Slid, load: float, left: float) -> Slid:
        for _ in range(_MOST_REVERSALS):
            pull = load - self.stiffness * here.position
            if here.velocity == 0.0 and abs(pull) <= self.coulomb:
                return here
            way = math.copysign(1.0, here.velocity or pull)
            series = self._series(here, load - way * self.coulomb)
            end = _reversal(series, left, way)
            position = _value(series, left if end is None else end)
            velocity = _slope(series, left) if end is None else 0.0
            length = left if end is None else end
            squared = length * sum(
                weight * _slope(series, place * length) ** 2 for place, weight in GAUSS
            )
            here = Slid(
                position,
                velocity,
                here.velocity_squared + squared,
                here.way + abs(position - here.position),
            )
            left -= length
            if end is None or left <= 0.0:
                return here
        # Too many reversals within the piece: it rests until the next one.
        return here

    def _series(self, here: Slid, load: float) -> list[float]:
        terms = [here.position, here.velocity]
        pull = load - self.stiffness * here.position - self.damping * here.velocity
        terms.append(pull / (2.0 * self.mass))
        for n in range(2, _TERMS - 1):
            against = self.damping * n * terms[n] + self.stiffness * terms[n - 1]
            terms.append(-against / (self.mass * n * (n + 1)))
        return terms


def _value(series: list[float], time: float) -> float:
    total = 0.0
    for term in reversed(series):
        total = total * time + term
    return total


def _slope(series: list[float], time: float) -> float:
    total = 0.0
    for n in range(len(series) - 1, 0, -1):
        total = total * time + n * series[n]
    return total


def _reversal(series: list[float], seconds: float, way: float) -> float | None:
    """Time when the velocity along `way` falls to zero, None if not within `seconds`."""
    if _slope(series, seconds) * way >= 0.0:
        return None
    before, after = 0.0, seconds
    for _ in range(_BISECTIONS):
        middle = 0.5 * (before + after)
        if _slope(series, middle) * way > 0.0:
            before = middle
        else:
            after = middle
    return after
