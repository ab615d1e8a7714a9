"""A firmness as a servo is told it."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

Told: TypeAlias = tuple[Sequence[float], Sequence[float]]

KNOTS = 32
LINEAR: Told = ((), ())


def told(firmness: tuple[float, float], unit: float, reach: float = 2.0) -> Told:
    """1 + a s + b s^2 of ``firmness`` (a, b) up to s = ``reach``; s^2 the energy over ``unit``,
    J/Pa.
    """
    s = reach * np.arange(1, KNOTS + 1) / KNOTS
    shares = 1.0 + firmness[0] * s + firmness[1] * s * s
    return (unit * s * s).tolist(), shares.tolist()
