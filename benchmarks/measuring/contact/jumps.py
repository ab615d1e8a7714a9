"""Jumps of force: what does not shrink when a path is followed in smaller steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from palpate.tests.referees.jumps import SPEED, along, largest_change

Vectors = NDArray[np.float64]

# Ticks a second, the servo's own first.
RATES = (1000, 4000, 16000, 64000)
# Changes that stand out are told from those of so many steps before and after.
BESIDE = 3


@dataclass(frozen=True)
class Jump:
    """What changed most on a path.

    Attributes
    ----------
    force : largest force, newton.
    step : largest change of force in a tick of the servo's own rate, newton.
    left : change that stands out of its neighbours at the finest steps, newton: the jump.
    exponent : p where the largest change goes with the step's length to the p: 1 is continuous,
        0 a jump.
    """

    force: float
    step: float
    left: float
    exponent: float

    @property
    def share(self) -> float:
        """The jump as a share of the largest force."""
        return self.left / self.force if self.force > 0.0 else 0.0


def jump_of(
    follow: Callable[[Vectors, int], Vectors],
    corners: Vectors,
    rates: tuple[int, ...] = RATES,
    speed: float = SPEED,
) -> Jump:
    """The jump of what ``follow`` answers, (ticks, m, 3) N, on paths (ticks, m, 3) and their rate.

    A higher rate is a smaller step at the same speed, so that all that takes time takes as long.
    """
    answers = [follow(along(corners, rate, speed), rate) for rate in rates]
    steps = np.array([largest_change(forces) for forces in answers])
    force = float(np.linalg.norm(answers[-1], axis=2).max())
    exponent = np.log(steps[0] / max(steps[-1], 1e-300)) / np.log(rates[-1] / rates[0])
    return Jump(force, float(steps[0]), standing_out(answers[-1]), float(exponent))


def standing_out(forces: Vectors) -> float:
    """By how much a change from one tick to the next differs most from those about it, newton.

    Where the force bends the changes go from one value to another, and the median of those about is
    one of both; where it jumps one change is alone.
    """
    changes = np.diff(forces, axis=0)
    beside = [k for k in range(-BESIDE, BESIDE + 1) if k != 0]
    inner = changes[BESIDE:-BESIDE]
    windows = np.stack([changes[BESIDE + k : len(changes) - BESIDE + k] for k in beside])
    # A bend may lie within the window: the nearer of the medians before and after counts.
    usual = np.stack([np.median(windows[:BESIDE], axis=0), np.median(windows[BESIDE:], axis=0)])
    return float(np.linalg.norm(inner - usual, axis=3).min(axis=0).max())
