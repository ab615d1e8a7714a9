"""What the simulated device weighs and who holds it: a mass between a motor's force and a hand.

    m x'' = F - b x' + k (x_hand - x) + c (x_hand' - x')        for each axis

b is the device's own friction, k and c are the hand's spring and damper. F and the hand's target
are constant within a step, for which the solution is exact: no step is too long for any stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass

Vector = tuple[float, float, float]
Matrix = list[list[float]]
ZERO: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Impedance:
    """Mass in kg, the device's damping and the hand's in N s/m, the hand's stiffness in N/m."""

    mass: float = 0.1
    damping: float = 0.5
    hand_stiffness: float = 500.0
    hand_damping: float = 10.0


def exponential(matrix: Matrix) -> Matrix:
    """Exponential of a small square matrix, by Taylor's series on a halved argument."""
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
    """One exact step of m x'' = -k x - c x' + f with constant f, for one axis."""

    xx: float
    xv: float
    xf: float
    vx: float
    vv: float
    vf: float

    @classmethod
    def over(cls, seconds: float, mass: float, stiffness: float, damping: float) -> Transition:
        """Work out the step; stiffness and damping may be zero."""
        rates = [
            [0.0, seconds, 0.0],
            [-stiffness / mass * seconds, -damping / mass * seconds, seconds / mass],
            [0.0, 0.0, 0.0],
        ]
        (xx, xv, xf), (vx, vv, vf), _ = exponential(rates)
        return cls(xx, xv, xf, vx, vv, vf)


class Plant:
    """The moving mass, in steps of a fixed length. Metres, metres per second, newtons."""

    def __init__(
        self, impedance: Impedance, step_seconds: float, position: Vector, brake: float = 0.0
    ) -> None:
        self.impedance = impedance
        self.step_seconds = step_seconds
        self.position = position
        self.velocity = ZERO
        self.target = position
        self.hand_force = ZERO
        """What the hand pushed with at the end of the last step."""
        self.work = 0.0
        """Energy the felt force has put into the device, J."""
        damping = impedance.damping + impedance.hand_damping
        self._free, self._braked = (
            Transition.over(step_seconds, impedance.mass, impedance.hand_stiffness, damping + more)
            for more in (0.0, brake)
        )

    def step(self, force: Vector, target: Vector, braked: bool = False) -> None:
        """Go one step on; the hand's target moves evenly from where it was to `target`."""
        move = self._braked if braked else self._free
        hand = self.impedance
        position, velocity, pushes = [0.0] * 3, [0.0] * 3, [0.0] * 3
        for axis in range(3):
            begin, end = self.target[axis], target[axis]
            pull = hand.hand_damping * (end - begin) / self.step_seconds
            load = force[axis] + pull + hand.hand_stiffness * 0.5 * (begin + end)
            x, v = self.position[axis], self.velocity[axis]
            position[axis] = move.xx * x + move.xv * v + move.xf * load
            velocity[axis] = move.vx * x + move.vv * v + move.vf * load
            self.work += force[axis] * (position[axis] - x)
            pushes[axis] = (
                hand.hand_stiffness * (end - position[axis])
                + pull
                - hand.hand_damping * velocity[axis]
            )
        self.position = (position[0], position[1], position[2])
        self.velocity = (velocity[0], velocity[1], velocity[2])
        self.hand_force = (pushes[0], pushes[1], pushes[2])
        self.target = target
