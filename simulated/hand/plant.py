"""Moving mass of the simulated device, between a motor's force and a hand.

    m x'' = F - b x' - f_c sign(x') + k (x_hand - x) + c (x_hand' - x')        for each axis

b and f_c are the device's own viscous and Coulomb friction, k and c are the hand's spring and
damper. F and the hand's target are constant within a step, so that the solution is exact for
steps of any length. Coulomb friction acts on each axis separately, as in a stage of three slides
(`coulomb.py`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...core.errors import PalpateError
from .coulomb import GAUSS, Slider

Vector = tuple[float, float, float]
Matrix = list[list[float]]
ZERO: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Impedance:
    """Impedance: mass in kg, damping of device and hand in N s/m, stiffness of the hand in N/m.

    coulomb : the device's Coulomb friction on each axis, N.
    """

    mass: float = 0.1
    damping: float = 0.5
    hand_stiffness: float = 500.0
    hand_damping: float = 10.0
    coulomb: float = 0.0


def exponential(matrix: Matrix) -> Matrix:
    """Exponential of a small square matrix, by scaling and squaring."""
    order = len(matrix)
    halvings = 0
    largest = max(sum(abs(entry) for entry in row) for row in matrix)
    while largest > 0.5:
        largest /= 2.0
        halvings += 1
    scaled = [[entry / 2.0**halvings for entry in row] for row in matrix]
    total = [[float(i == j) for j in range(order)] for i in range(order)]
    term = total
    for power in range(1, 18):
        term = [[entry / power for entry in row] for row in _product(term, scaled)]
        total = [
            [a + b for a, b in zip(*rows, strict=True)] for rows in zip(total, term, strict=True)
        ]
    for _ in range(halvings):
        total = _product(total, total)
    return total


def _product(left: Matrix, right: Matrix) -> Matrix:
    columns = list(zip(*right, strict=True))
    return [
        [sum(a * b for a, b in zip(row, column, strict=True)) for column in columns] for row in left
    ]


@dataclass(frozen=True)
class Transition:
    """Exact step of m x'' = -k x - c x' + f with constant f, for one axis."""

    xx: float
    xv: float
    xf: float
    vx: float
    vv: float
    vf: float

    @classmethod
    def over(cls, seconds: float, mass: float, stiffness: float, damping: float) -> Transition:
        """Compute the step; stiffness and damping may be zero."""
        rates = [
            [0.0, seconds, 0.0],
            [-stiffness / mass * seconds, -damping / mass * seconds, seconds / mass],
            [0.0, 0.0, 0.0],
        ]
        (xx, xv, xf), (vx, vv, vf), _ = exponential(rates)
        return cls(xx, xv, xf, vx, vv, vf)


@dataclass
class EnergyBooks:
    """Energy balance since the start, J.

    motor + hand = kinetic + viscous + coulomb, if the mass was at rest at the start.
    """

    motor: float = 0.0
    """Work of the motors' force on the device."""
    hand: float = 0.0
    """Work of the hand's spring and damper on the device."""
    viscous: float = 0.0
    """Dissipated by the device's damping and brake."""
    coulomb: float = 0.0
    """Dissipated by Coulomb friction."""


@dataclass(frozen=True)
class _Axis:
    """Axis with one damping: the exact step, its inner places, and the step with friction."""

    device_damping: float
    slider: Slider
    full: Transition
    inner: tuple[tuple[Transition, float], ...]

    @classmethod
    def of(cls, hand: Impedance, seconds: float, brake: float) -> _Axis:
        damping = hand.damping + hand.hand_damping + brake

        def over(part: float) -> Transition:
            return Transition.over(part * seconds, hand.mass, hand.hand_stiffness, damping)

        return cls(
            hand.damping + brake,
            Slider(hand.mass, hand.hand_stiffness, damping, hand.coulomb),
            over(1.0),
            tuple((over(place), weight * seconds) for place, weight in GAUSS),
        )

    def step(self, x: float, v: float, load: float) -> tuple[float, float, float]:
        """State after a step without Coulomb friction: position, velocity and integral of v^2."""
        squared = sum(
            weight * (part.vx * x + part.vv * v + part.vf * load) ** 2
            for part, weight in self.inner
        )
        move = self.full
        return (
            move.xx * x + move.xv * v + move.xf * load,
            move.vx * x + move.vv * v + move.vf * load,
            squared,
        )


class Plant:
    """Moving mass, in steps of fixed length. Metres, metres per second, newtons.

    Raises PalpateError if, with Coulomb friction, a step is far too long for the mass.
    """

    def __init__(
        self, impedance: Impedance, step_seconds: float, position: Vector, brake: float = 0.0
    ) -> None:
        self.impedance = impedance
        self.step_seconds = step_seconds
        self.position = position
        self.velocity = ZERO
        self.target = position
        self.hand_force = ZERO
        """Force of the hand at the end of the last step."""
        self.energy = EnergyBooks()
        self._free, self._braked = (
            _Axis.of(impedance, step_seconds, more) for more in (0.0, brake)
        )
        if impedance.coulomb > 0.0 and not self._braked.slider.can_step(step_seconds):
            raise PalpateError(
                "simulated device: with --coulomb its mass is too small for the hand and dampers; "
                "take more mass, or less stiffness and damping"
            )

    @property
    def work(self) -> float:
        """Work of the motors' force on the device, J."""
        return self.energy.motor

    @property
    def kinetic(self) -> float:
        """Kinetic energy of the moving mass, J."""
        return 0.5 * self.impedance.mass * math.hypot(*self.velocity) ** 2

    def step(self, force: Vector, target: Vector, braked: bool = False) -> None:
        """Advance one step; the hand's target moves linearly to `target`."""
        moving = self._braked if braked else self._free
        hand, books = self.impedance, self.energy
        position, velocity, pushes = [0.0] * 3, [0.0] * 3, [0.0] * 3
        for axis in range(3):
            begin, end = self.target[axis], target[axis]
            pull = hand.hand_damping * (end - begin) / self.step_seconds
            load = force[axis] + pull + hand.hand_stiffness * 0.5 * (begin + end)
            before = self.position[axis]
            if hand.coulomb > 0.0:
                slid = moving.slider.step(before, self.velocity[axis], load, self.step_seconds)
                x, v, squared = slid.position, slid.velocity, slid.velocity_squared
                books.coulomb += hand.coulomb * slid.way
            else:
                x, v, squared = moving.step(before, self.velocity[axis], load)
            position[axis], velocity[axis] = x, v
            way = x - before
            reach = 0.5 * (begin + end) - 0.5 * (before + x)
            books.motor += force[axis] * way
            books.hand += (hand.hand_stiffness * reach + pull) * way - hand.hand_damping * squared
            books.viscous += moving.device_damping * squared
            pushes[axis] = hand.hand_stiffness * (end - x) + pull - hand.hand_damping * v
        self.position = (position[0], position[1], position[2])
        self.velocity = (velocity[0], velocity[1], velocity[2])
        self.hand_force = (pushes[0], pushes[1], pushes[2])
        self.target = target
