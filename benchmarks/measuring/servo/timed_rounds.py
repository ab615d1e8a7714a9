"""Times of a servo's ticks along one path, led several times."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from palpate_servo.harness import SteppedFingers

Floats = NDArray[np.float64]


def timed_rounds(
    come: Callable[[], SteppedFingers], path: Floats, rounds: int = 5
) -> tuple[Floats, SteppedFingers]:
    """Processor's time of each tick along ``path`` (ticks, fingers, 3), (rounds, ticks), s, and the
    last round's fingers.

    What a tick computes is the same in each round, and what else the machine does is not: the least
    time of each tick is nearest to its computing. ``come`` makes fingers that have come to where
    the path begins.
    """
    every = [come() for _ in range(rounds)]
    return np.array([fingers.costs(path) for fingers in every]), every[-1]
