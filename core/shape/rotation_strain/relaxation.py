"""From the warped shape towards equilibrium, in a fixed number of steps that depend smoothly on F.

Warping keeps a bend's size, but knows nothing of equilibrium: the lever of a force shortens as a
body bends, and what is crushed or drawn out hardens or softens. So the total energy is minimised,
as a function of the *linear* displacement v that is warped to u = W(v):

    p(v) = U(W(v)) - F . W(v)

In these coordinates it is nearly the quadratic function 1/2 v.Kv - F.v whatever the rotations, and
quasi-Newton steps from K^-1, which is at hand, come close in very few: where steps in u have to
undo each rotation's false stretch, these turn what they move.

Steps are those of the limited-memory BFGS method with K^-1 as the first inverse Hessian and
Powell's damping; the length of each is where the parabola through value and slope at its start and
value at its end is lowest, at most the whole. All of it depends continuously on the forces.

References
----------
J. Nocedal, S. J. Wright: Numerical Optimization, Springer, 2nd edition, 2006; L-BFGS in section
7.2, damping in section 18.3.
T. Liu, S. Bouaziz, L. Kavan: Quasi-Newton Methods for Real-Time Simulation of Hyperelastic
Materials, ACM Transactions on Graphics 36, 2017; there in displacements.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...compliance.elimination.cholesky import CholeskyFactor
from ...law.by_component import Array
from ...law.law import Law
from ..solid.springs import Springs
from ..solid.strain_energy import StrainEnergy, StressedSolid
from ..solid.strain_term import StrainTerm
from .warp import RotationStrain, Warped

# A parabola at least this far ahead of the end of a step takes the whole step: the energy is no
# parabola, and a step that is nearly right is cheaper taken than looked at again.
WHOLE_FROM = 0.8
SHORTEST_STEP = 0.05
# Powell's: a pair of changes keeps at least this share of the curvature that was expected.
LEAST_CURVATURE = 0.2

Solve = Callable[[Array], Array]


def by_component(factor: CholeskyFactor) -> Solve:
    """Solves by a factor whose freedoms go node by node."""

    def solve(forces: Array) -> Array:
        moved: Array = factor.solve(forces.T.ravel())
        return np.ascontiguousarray(moved.reshape(-1, 3).T)

    return solve


@dataclass(frozen=True, eq=False)
class Load:
    """Load on the nodes.

    Attributes
    ----------
    dead : (3, f), forces that keep their directions.
    turning : (3, f), forces on the linear displacements, whose work does not change where the body
        turns; None for none.
    """

    dead: Array
    turning: Array | None = None

    @property
    def total(self) -> Array:
        """The load (3, f) of the linear body."""
        return self.dead if self.turning is None else self.dead + self.turning

    def work(self, place: Warped, linear: Array) -> float:
        """Work of the full load, joule."""
        dead = dot(self.dead, place.displacements)
        return dead if self.turning is None else dead + dot(self.turning, linear)


@dataclass(frozen=True, eq=False)
class Relaxation:
    """Total energy of a body under forces, over its linear displacements.

    Attributes
    ----------
    coordinates : the warp.
    energy : of the body on its free nodes, at unit modulus.
    solve : K^-1 on nodal forces (3, f).
    """

    coordinates: RotationStrain
    energy: StrainEnergy
    solve: Solve

    @classmethod
    def of(
        cls, terms: Sequence[StrainTerm], law: Law, solve: Solve, springs: Springs | None = None
    ) -> Relaxation:
        """Relaxation of the terms of a solid on its free nodes, the first of which has shear.

        Parameters
        ----------
        solve : by the stiffness of the terms and the springs.
        """
        coordinates = RotationStrain.of(terms[0], springs).factored()
        return cls(coordinates, StrainEnergy(tuple(terms), law, springs), solve)

    def relaxed(self, forces: Array, steps: int) -> Array:
        """Displacements (3, f) of the free nodes under ``forces`` (3, f), after so many steps.

        Without steps it is the warped linear displacement.
        """
        return self.relaxed_from(self.solve(forces), Load(forces), steps)

    def relaxed_from(self, linear: Array, load: Load, steps: int) -> Array:
        """Relaxed shape under a load whose linear displacement (3, f) is known."""
        total = load.total
        if not steps or not total.any():
            return self.coordinates.warp(linear).displacements
        here, share = self._nearer(_Place.at(linear, load, self), load)
        slope = self._gradient(here, load)
        # At rest the gradient is known without any work, so the way from there counts as a step.
        history = [_Change.damped(share, linear, -total, slope)]
        for step in range(steps):
            direction = _direction(slope, history, self.solve)
            most = _bound(dot(total, linear), -dot(slope, direction))
            there = _Place.at(here.linear + most * direction, load, self)
            share = step_length(here.potential, most * dot(slope, direction), there.potential)
            if step + 1 == steps:
                # On the chord: warping once more would change little.
                start, end = here.warped.displacements, there.warped.displacements
                return start + share * (end - start)
            if share < 1.0:
                there = _Place.at(here.linear + share * most * direction, load, self)
            after = self._gradient(there, load)
            history.append(_Change.damped(share * most, direction, slope, after))
            here, slope = there, after
        return here.warped.displacements

    def _nearer(self, place: _Place, load: Load) -> tuple[_Place, float]:
        """The place on the way from rest: all of it, or the share of it where a body hardens."""
        share = step_length(0.0, -dot(load.total, place.linear), place.potential)
        return place if share == 1.0 else _Place.at(share * place.linear, load, self), share

    def _gradient(self, place: _Place, load: Load) -> Array:
        unbalanced = self.energy.forces(place.stressed) - load.dead
        gradient = self.coordinates.pulled_back(place.warped, unbalanced)
        return gradient if load.turning is None else gradient - load.turning


def _bound(work: float, descent: float) -> float:
    """Share of a step, at most 1, whose work on its own stiffness is that of the linear shape.

    ``work`` is F K^-1 F, ``descent`` g H g. Where steps of sense are smaller by far this bounds
    those of a body beyond its collapse, whose gradients grow with the cube of what is wrong.
    """
    return 1.0 if descent <= work else math.sqrt(work / descent)


def step_length(start: float, slope: float, end: float) -> float:
    """Share of a step at which the parabola through these values is lowest, 0.05 to 1.

    ``slope`` is the derivative at the start along the whole step, zero or less.
    """
    curvature = 2.0 * (end - start - slope)
    if -slope >= WHOLE_FROM * curvature:
        return 1.0
    return max(SHORTEST_STEP, -slope / (WHOLE_FROM * curvature))


def dot(a: Array, b: Array) -> float:
    """The work of nodal forces ``a`` on displacements ``b``, both (3, f)."""
    return float(np.einsum("if,if->", a, b))


@dataclass(frozen=True, eq=False)
class _Place:
    """Linear displacements (3, f), what they are warped to, and the total energy there."""

    linear: Array
    warped: Warped
    stressed: StressedSolid
    potential: float

    @classmethod
    def at(cls, linear: Array, load: Load, body: Relaxation) -> _Place:
        warped = body.coordinates.warp(linear)
        stressed = body.energy.stressed(warped.displacements)
        potential = stressed.energy - load.work(warped, linear)
        return cls(linear, warped, stressed, potential)


@dataclass(frozen=True, eq=False)
class _Change:
    """Change of place and gradient by a step, and the work of the two."""

    place: Array
    gradient: Array
    work: float

    @classmethod
    def damped(cls, share: float, direction: Array, before: Array, after: Array) -> _Change:
        """Change by a step of ``share`` of a direction, -H times the gradient ``before``."""
        place = share * direction
        gradient = after - before
        # H^-1 times the step is known without H: it is -share times the gradient.
        expected = -share * dot(before, place)
        work = dot(place, gradient)
        if work < LEAST_CURVATURE * expected:
            kept = (1.0 - LEAST_CURVATURE) * expected / (expected - work)
            gradient = kept * gradient - (1.0 - kept) * share * before
            work = LEAST_CURVATURE * expected
        return cls(place, gradient, work)


def _direction(slope: Array, history: list[_Change], solve: Solve) -> Array:
    """Minus the inverse Hessian of BFGS times the gradient, by two loops over the changes."""
    left = slope.copy()
    shares = []
    for change in reversed(history):
        share = _ratio(dot(change.place, left), change.work)
        left -= share * change.gradient
        shares.append(share)
    direction = solve(left)
    for change, share in zip(history, reversed(shares), strict=True):
        direction += (share - _ratio(dot(change.gradient, direction), change.work)) * change.place
    return -direction


def _ratio(work: float, curvature: float) -> float:
    """Zero where the change is: it has arrived."""
    return work / curvature if curvature > 0.0 else 0.0
