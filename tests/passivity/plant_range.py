"""The devices that the servo's default couplings are made for: `docs/stability.md`."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from .contact_loop import DevicePlant

Interval = tuple[float, float]


@dataclass(frozen=True)
class PlantRange:
    """Least and most of each property; SI units."""

    mass: Interval = (0.05, 0.5)
    damping: Interval = (0.2, 2.0)
    coulomb: Interval = (0.03, 0.3)
    encoder_step: Interval = (1e-6, 60e-6)
    force_step: Interval = (1e-3, 5e-3)
    delay: Interval = (0.0, 2e-3)
    rate_hz: tuple[int, int] = (1000, 4000)
    coulomb_per_step: float = 1500.0
    """A device with coarse encoders has friction that goes with them, N/m."""

    def _plant(self, values: Iterable[float], jitter: float, rate_hz: int) -> DevicePlant:
        mass, damping, coulomb, encoder_step, force_step, delay = values
        rubbing = max(coulomb, self.coulomb_per_step * encoder_step)
        # The random part of the delay is inside the range, not beside it.
        return DevicePlant(
            mass,
            damping,
            rubbing,
            encoder_step,
            force_step,
            delay * (1.0 - jitter),
            delay * jitter,
            rate_hz,
        )

    @property
    def _intervals(self) -> tuple[Interval, ...]:
        return (
            self.mass,
            self.damping,
            self.coulomb,
            self.encoder_step,
            self.force_step,
            self.delay,
        )

    def corners(self) -> Iterator[DevicePlant]:
        """All 128, without jitter."""
        for values in itertools.product(*self._intervals):
            for rate_hz in self.rate_hz:
                yield self._plant(values, 0.0, rate_hz)

    def drawn(self, count: int, seed: int) -> Iterator[DevicePlant]:
        """Plants from inside, evenly over the logarithm, half of them with some jitter."""
        dice = random.Random(seed)  # noqa: S311 - plants, not secrets

        def within(interval: Interval) -> float:
            low, high = interval
            if low <= 0.0:
                return dice.uniform(low, high)
            return math.exp(dice.uniform(math.log(low), math.log(high)))

        for number in range(count):
            yield self._plant(
                [within(interval) for interval in self._intervals],
                0.5 * dice.random() * (number % 2),
                round(within((float(self.rate_hz[0]), float(self.rate_hz[1])))),
            )


RANGE = PlantRange()
"""Hobby and desktop devices."""

COARSE = PlantRange(
    mass=(0.05, 0.3),
    coulomb=(0.05, 0.3),
    encoder_step=(0.08e-3, 0.4e-3),
    rate_hz=(1000, 2000),
    coulomb_per_step=0.0,
)
"""Devices with coarse encoders, such as Haply's 2DIY."""
