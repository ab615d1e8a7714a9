"""Balance of a durometer: its foot and indenter pressed into a body, until body and spring agree.

The foot lies on the surface, the indenter stands out of it by p and pushes with the force that its
spring has then; both are rigid, push along the device's axis only, and may not pull:

    w = C f >= d,  f >= 0,  f (w - d) = 0

(the least of 1/2 f C f - d f over f >= 0: nonnegative least squares) with the depths d at which
foot and indenter stand below the rest surface. The spring is linear, so that p goes into the same
problem, as a compliance that all points of the indenter share.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from ..errors import PalpateError
from .durometer_points import Seat
from .scales.durometer_type import DurometerType

# Relative tolerance of the load on the foot.
LOAD_TOLERANCE = 1e-4
MOST_STEPS = 60
# Eigenvalues of the compliance below this share of the largest are rounding, negative ones too.
ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class Balance:
    """Equilibrium of a durometer and a body.

    Attributes
    ----------
    reading : 0 to 100.
    pushes : float64 (p,), forces of the points on the body along the axis, newton.
    depth : of the indenter below the foot, metres.
    foot_depth : of the foot below its first touch, metres.
    """

    reading: float
    pushes: NDArray[np.float64]
    depth: float
    foot_depth: float


def balanced(
    compliance: NDArray[np.float64], seat: Seat, kind: DurometerType, load: float | None
) -> Balance:
    """Balance on a body of ``compliance`` (p, p) along the axis, m/N.

    With a load, the foot sinks until the sum of all forces is the load.

    Raises
    ------
    PalpateError
        The load is not reached within :data:`MOST_STEPS`.
    """
    laid_on = float(seat.heights[~seat.tip].min(initial=float(seat.heights[seat.tip].min())))
    if load is None:
        return _at_depth(compliance, seat, kind, laid_on, laid_on)
    # The force is convex in the depth: Newton's steps from below hardly overshoot, and bisection
    # limits them.
    above, below = laid_on - kind.travel, np.inf
    foot, found = laid_on, _at_depth(compliance, seat, kind, laid_on, laid_on)
    for _ in range(MOST_STEPS):
        missing = load - float(found.pushes.sum())
        if abs(missing) <= LOAD_TOLERANCE * load:
            return found
        above, below = (foot, below) if missing > 0.0 else (above, foot)
        pressed = np.flatnonzero(found.pushes > 0.0)
        step = np.inf
        if pressed.size:
            sprung = _sprung(compliance, seat.tip, kind, found.depth)[np.ix_(pressed, pressed)]
            step = missing / float(np.linalg.solve(sprung, np.ones(len(pressed))).sum())
        foot += step
        if not above < foot < below:
            foot = 0.5 * (above + below) if np.isfinite(below) else above + kind.travel
        found = _at_depth(compliance, seat, kind, foot, laid_on)
    raise PalpateError(
        "durometer: no depth was found at which the foot carries {load:g} N there; lay it on "
        "without a load, or choose another place",
        load=load,
    )


def _at_depth(
    compliance: NDArray[np.float64],
    seat: Seat,
    kind: DurometerType,
    foot: float,
    laid_on: float,
) -> Balance:
    """Balance of the indenter while the foot stands ``foot`` metres below the place."""
    tip = seat.tip
    gaps = seat.heights - foot
    gaps[tip] += kind.profile(seat.radii[tip])
    # p = travel - (force - force_at_zero) * softness, as long as neither of its stops is reached.
    softness = _spring_softness(kind)
    standing = kind.travel + kind.force_at_zero * softness
    sprung = compliance + softness * np.outer(tip, tip)
    pushes = _pushes(sprung, gaps - standing * tip)
    depth = standing - softness * float(pushes[tip].sum())
    if not 0.0 <= depth <= kind.travel:
        depth = min(max(depth, 0.0), kind.travel)
        pushes = _pushes(compliance, gaps - depth * tip)
    return Balance(100.0 * (1.0 - depth / kind.travel), pushes, depth, foot - laid_on)


def _pushes(compliance: NDArray[np.float64], gaps: NDArray[np.float64]) -> NDArray[np.float64]:
    """Forces f >= 0 (p,) with gaps C f + g >= 0, one of both zero at each point."""
    values, vectors = np.linalg.eigh(compliance)
    roots = np.sqrt(np.maximum(values, ROUNDING * values[-1]))
    root: NDArray[np.float64] = vectors.T * roots[:, None]
    forces, _ = nnls(root, -(vectors.T @ gaps) / roots)
    return np.asarray(forces, dtype=np.float64)


def _spring_softness(kind: DurometerType) -> float:
    """Compliance of the spring, metres per newton."""
    return kind.travel / (100.0 * kind.force_per_point)


def _sprung(
    compliance: NDArray[np.float64], tip: NDArray[np.bool_], kind: DurometerType, depth: float
) -> NDArray[np.float64]:
    """Compliance with that of the spring, unless the indenter is at a stop."""
    if not 0.0 < depth < kind.travel:
        return compliance
    return compliance + _spring_softness(kind) * np.outer(tip, tip)
