"""Equilibrium under forces that do not follow the body, by Newton's method in load steps.

No element inverts on the way. By a law that does not give way, the energy of body and load falls
with every step until it is lowest: where the tangent has directions that lead uphill, they are left
out of it, and a body that buckles comes to rest beside.

By St. Venant-Kirchhoff's law, whose stress falls again once a cell has lost some tenths of its
height, followed is the branch of stable equilibria that begins at rest: tangents are positive
definite throughout. Where that branch ends, :class:`NoEquilibrium` tells how much of the load it
has carried. A load step that is taken at once could land on another branch; small ones cannot.

References
----------
J. Nocedal, S. J. Wright: Numerical Optimization, 2nd edition, Springer, 2006, chapter 3.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...compliance.elimination.cholesky import CholeskyFactor, NotPositiveDefiniteError
from ...errors import PalpateError
from ...progress import unwatched
from .free_solid import FreeSolid
from .inversion import is_upright, unhindered_share

# Residual forces, as a share of the load, at which an equilibrium is found. On the way there,
# between load steps, less will do.
RESIDUAL_SHARE = 1e-11
RESIDUAL_SHARE_ON_THE_WAY = 1e-3

# Load steps are halved when one fails, and doubled after one that took few iterations.
SMALLEST_STEP = 1 / 512
FEW_ITERATIONS = 5
MOST_ITERATIONS = 16

# Sufficient decrease of the energy, as a share of what its slope promises, and the shortest part of
# a Newton step that is tried.
SUFFICIENT_DECREASE = 1e-4
SHORTEST_PART = 1 / 64

# Rounding of an energy, relative to the parts it is summed of.
ROUNDING = 1e-14

# Where bodies are slender, stresses inside are so much larger than the load that a residual above
# the wanted share is rounding. It is taken for that below this share, once it no longer falls by
# this factor.
LARGEST_ROUNDING_SHARE = 1e-8
STALLED = 0.1


class NoEquilibrium(PalpateError):  # noqa: N818 - it is a result of mechanics, not a mistake
    """No stable equilibrium was reached from rest without inverting an element.

    Attributes
    ----------
    held : share of the load, 0 to 1, that still had one.
    displacements : (f, 3), there.
    """

    def __init__(self, held: float, displacements: NDArray[np.float64]) -> None:
        super().__init__(
            "large deformation: the body gives way at {held:.1%} of the load; use less force or a "
            "stiffer body",
            held=held,
        )
        self.held = held
        self.displacements = displacements


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A body at rest under its load.

    Attributes
    ----------
    displacements : (f, 3) of the free nodes, metres.
    load_steps : how many parts the load was applied in.
    iterations : Newton steps in all, those of failed load steps included, from ``start`` or rest.
    residual : largest force that is not balanced, as a share of the largest of the load.
    history : that share before every iteration of the last load step, and at its end.
    """

    displacements: NDArray[np.float64]
    load_steps: int
    iterations: int
    residual: float
    history: tuple[float, ...]


def equilibrium(
    body: FreeSolid,
    forces: NDArray[np.float64],
    start: NDArray[np.float64] | None = None,
    largest_step: float = 1.0,
    smallest_step: float = SMALLEST_STEP,
    may_go_on: Callable[[], None] = unwatched,
) -> Equilibrium:
    """The body under ``forces`` (f, 3), newton per pascal of Young's modulus.

    Parameters
    ----------
    body : the solid with its pins.
    forces : on the free nodes; they keep their directions.
    start : (f, 3), displacements near the equilibrium. If the way from there to it is short, no
        load steps are needed. Otherwise they begin at rest.

    Raises
    ------
    NoEquilibrium
        The load is more than the body carries.
    """
    if not forces.any():
        return Equilibrium(np.zeros_like(forces), 0, 0, 0.0, ())
    if start is not None:
        found = equilibrium_near(body, forces, start, RESIDUAL_SHARE, may_go_on)
        if found is not None:
            return found
    reached, held, steps, iterations = np.zeros_like(forces), 0.0, 0, 0
    # Newton's first step is the linear one: more load than that can take is not tried at once.
    share = min(largest_step, 2.0 * unhindered_share(body.solid, reached, body.linear(forces)))
    smallest_step = min(smallest_step, 0.25 * share)
    while True:
        target = min(held + share, 1.0)
        tolerance = RESIDUAL_SHARE if target == 1.0 else RESIDUAL_SHARE_ON_THE_WAY
        step = _newton(body, target * forces, reached, tolerance, may_go_on)
        iterations += step.iterations
        if step.found:
            reached, held, steps = step.displacements, target, steps + 1
            if held == 1.0:
                return Equilibrium(reached, steps, iterations, step.history[-1], step.history)
            if step.iterations <= FEW_ITERATIONS:
                share = min(2.0 * share, largest_step)
        else:
            share = 0.5 * min(share, target - held)
            if share < smallest_step:
                raise NoEquilibrium(held, reached)


def equilibrium_near(
    body: FreeSolid,
    forces: NDArray[np.float64],
    start: NDArray[np.float64],
    residual_share: float,
    may_go_on: Callable[[], None] = unwatched,
) -> Equilibrium | None:
    """The body under ``forces`` (f, 3), from displacements (f, 3) nearby; None if none is there.

    ``residual_share`` is the largest force left unbalanced, as a share of the largest of the load.
    """
    if not is_upright(body.solid, start):
        return None
    step = _newton(body, forces, start, residual_share, may_go_on)
    if not step.found:
        return None
    return Equilibrium(step.displacements, 1, step.iterations, step.history[-1], step.history)


@dataclass(frozen=True, eq=False)
class _Step:
    found: bool
    displacements: NDArray[np.float64]
    history: tuple[float, ...]

    @property
    def iterations(self) -> int:
        return len(self.history) - 1


def _newton(
    body: FreeSolid,
    forces: NDArray[np.float64],
    start: NDArray[np.float64],
    tolerance: float,
    may_go_on: Callable[[], None],
) -> _Step:
    """Newton's method for one load, from displacements without inverted elements."""
    load = float(np.abs(forces).max())
    point = _Point.at(body, forces, start)
    history: list[float] = []
    for _ in range(MOST_ITERATIONS):
        may_go_on()
        worst = float(np.abs(point.residual).max())
        history.append(worst / load)
        is_small = worst <= LARGEST_ROUNDING_SHARE * load
        has_stalled = len(history) > 1 and history[-1] > STALLED * history[-2]
        if worst <= tolerance * load or (is_small and has_stalled):
            return _Step(True, point.displacements, tuple(history))
        factor = _factor(body, point.displacements)
        if factor is None:
            break
        way = factor.solve(point.residual.ravel()).reshape(-1, 3)
        further = _searched(body, forces, point, way)
        if further is None:
            # No way lowers the energy further, as far as its numbers tell.
            return _Step(is_small, point.displacements, tuple(history))
        point = further
    return _Step(False, point.displacements, tuple(history))


def _factor(body: FreeSolid, displacements: NDArray[np.float64]) -> CholeskyFactor | None:
    """The factor of the tangent or, where the law does not give way, of its convex part."""
    for convex in (False, True) if not body.solid.law.gives_way else (False,):
        blocks = body.solid.tangent_blocks(displacements, convex=convex)
        try:
            return body.elimination.factor(blocks)
        except NotPositiveDefiniteError:
            continue
    return None


@dataclass(frozen=True, eq=False)
class _Point:
    """Displacements, the energy of body and load there, and the forces that are not balanced."""

    displacements: NDArray[np.float64]
    energy: float
    residual: NDArray[np.float64]

    @classmethod
    def at(
        cls, body: FreeSolid, forces: NDArray[np.float64], displacements: NDArray[np.float64]
    ) -> _Point:
        energy = body.energy(displacements) - float((forces * displacements).sum())
        return cls(displacements, energy, forces - body.forces(displacements))


def _searched(
    body: FreeSolid, forces: NDArray[np.float64], point: _Point, way: NDArray[np.float64]
) -> _Point | None:
    """The first of ever shorter parts of ``way`` that lowers the energy enough, if one does."""
    slope = float((point.residual * way).sum())
    part = unhindered_share(body.solid, point.displacements, way)
    while part >= SHORTEST_PART:
        trial = _Point.at(body, forces, point.displacements + part * way)
        # Near the equilibrium the energy changes by less than it is known to.
        rounding = ROUNDING * (
            abs(point.energy) + float(np.abs(forces * trial.displacements).sum())
        )
        expected = SUFFICIENT_DECREASE * part * slope
        if trial.energy <= point.energy - expected + rounding and is_upright(
            body.solid, trial.displacements
        ):
            return trial
        part *= 0.5
    return None
