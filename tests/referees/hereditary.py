"""The force of a body that gives way with time, slowly and in numpy, from what an elastic one does.

While contact grows, the force of a linear body at a constant Poisson's ratio is ::

    F(t) = integral of E(t - s) / E dF_e(s)

with F_e the force at the modulus in the end under the same way (E. H. Lee and J. R. M. Radok: The
contact problem for viscoelastic bodies, Journal of Applied Mechanics 27, 1960, 438-444). While it
shrinks, the force is that of the way in to the time t1(t) at which contact was as wide as now (T.
C. T. Ting: The contact stresses between a rigid indenter and a viscoelastic half-space, Journal of
Applied Mechanics 33, 1966, 845-854), d the depth::

    F(t) = integral to t1 of E(t - s) / E dF_e(s),     0 = integral from t1 to t of E(t - s) dd(s)
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def held_force(
    series: Sequence[tuple[float, float]], elastic: NDArray[np.float64], dt: float
) -> NDArray[np.float64]:
    """F (n,) of an elastic force F_e (n,) that goes evenly from tick to tick, every ``dt`` s.

    ``series`` are pairs of a share of the modulus in the end and of seconds.
    """
    steps = np.diff(elastic, prepend=0.0)
    found = elastic.copy()
    for share, seconds in series:
        x, left = dt / seconds, 0.0
        for tick, step in enumerate(steps):
            left = left * np.exp(-x) + share * step * -np.expm1(-x) / x
            found[tick] += left
    return found


def creep(series: Sequence[tuple[float, float]], ticks: int, dt: float) -> NDArray[np.float64]:
    """What an elastic force has to grow by (ticks,) for :func:`held_force` of it to stay 1."""
    shares, seconds = np.array(series).T
    x = dt / seconds
    own, left, found = -np.expm1(-x) / x, np.zeros(len(x)), np.zeros(ticks)
    grown = 0.0
    for tick in range(ticks):
        left *= np.exp(-x)
        step = (1.0 - grown - left.sum()) / (1.0 + shares @ own)
        left += shares * step * own
        grown += step
        found[tick] = grown
    return found


def retreating_force(
    series: Sequence[tuple[float, float]],
    elastic: NDArray[np.float64],
    depths: NDArray[np.float64],
    dt: float,
) -> NDArray[np.float64]:
    """F (n,) of a finger whose depth (n,) grows and then falls, from the elastic force (n,) of the
    way in; zero from where it has let go.
    """
    moved, pushed = (np.diff(one, prepend=0.0) for one in (depths, elastic))
    turn, found = int(np.argmax(depths)), held_force(series, elastic, dt)
    middles = dt * (np.arange(len(depths)) + 0.5)
    for tick in range(turn + 1, len(depths)):
        age = dt * (tick + 1) - middles[: tick + 1]
        firm = 1.0 + sum(share * np.exp(-age / seconds) for share, seconds in series)
        # What is pulled back since each tick, from the last to the first, and where that is none.
        since = np.cumsum((firm * moved[: tick + 1])[::-1])[::-1]
        wide = np.flatnonzero(since[: turn + 1] >= 0.0)
        if not len(wide):
            found[tick:] = 0.0
            break
        last = int(wide[-1])
        share = since[last] / (since[last] - since[last + 1])
        force = firm * pushed[: tick + 1]
        found[tick] = force[:last].sum() + share * force[last]
    return found
