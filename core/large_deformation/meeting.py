"""Loads under which a large-deformation shape meets the fingers that press it.

The force that is felt comes from the linear relation, under which the linear shape moves exactly as
the fingers do. Under the same force another shape moves its touched places elsewhere: the bend of
an ear goes along an arc. What is drawn shall touch the finger; so each finger's load is changed by
a force c, shared by its nodes as the load itself is, until the touched place is where the linear
shape has it. Broyden's method finds c; between two frames it goes on where it was.

Reference
---------
C. G. Broyden: A class of methods for solving nonlinear simultaneous equations, Mathematics of
Computation 19 (1965), 577-593.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..soft_body import SoftBody
from .shapes import LinearShape, Shape

Array = NDArray[np.float64]

# A place is met when it is missed by less than this share of its way.
MET = 0.01
# A step changes the loads by no more than this share of the largest one; it is halved where steps
# bring nothing, and below the least the fingers cannot be met. What is missed by little is no sign.
LARGEST_STEP, LEAST_STEP, LITTLE = 0.5, 0.02, 0.05
# Beyond this many times the linear load a finger is asked for what the shape cannot do.
LARGEST_LOAD = 20.0
# Fingers that moved by this share of their way are followed again.
MOVED_ON = 0.05
# Steps when somebody waits for the answer.
MOST_STEPS = 40


@dataclass(frozen=True, eq=False)
class FingerLoad:
    """What one finger does by the linear relation: forces (k, 3), N, on nodes (k,) of the mesh."""

    nodes: NDArray[np.int64]
    forces: Array

    @property
    def weights(self) -> Array:
        """Share (k,) of the load that each node carries; of no load, alike."""
        sizes = np.linalg.norm(self.forces, axis=1)
        total = sizes.sum()
        alike = np.full(len(sizes), 1.0 / max(1, len(sizes)))
        shares: Array = sizes / total if total > 0.0 else alike
        return shares


@dataclass(frozen=True, eq=False)
class Met:
    """A shape that meets the fingers.

    Attributes
    ----------
    displacements : (n, 3) of the free surface nodes, metres.
    linear : the same of the linear shape.
    missed : largest distance between a touched place and where it should be, as a share of the
        longest way.
    """

    displacements: Array
    linear: Array
    missed: float

    @property
    def settled(self) -> bool:
        """Whether another step would not be seen."""
        return self.missed <= MET


@dataclass(eq=False)
class Meeting:
    """Follows the fingers from frame to frame; make a new one for another body or shape."""

    body: SoftBody
    shape: Shape
    # All loads are kept at unit modulus, so that the modulus can be changed while it goes on.
    _fingers: tuple[tuple[int, ...], ...] = ()
    _added: Array = field(default_factory=lambda: np.zeros((0, 3)))
    _inverse: Array = field(default_factory=lambda: np.zeros((0, 0)))
    _before: tuple[Array, Array] | None = None
    _gave_up: Array | None = None
    # How large steps may be, and the least that was missed with which added load.
    _trust: float = LARGEST_STEP
    _best: tuple[float, Array] | None = None

    def step(self, fingers: Sequence[FingerLoad], young_modulus: float) -> Met:
        """The shape under these loads, one step nearer to the fingers than the last one."""
        loads = [FingerLoad(load.nodes, load.forces / young_modulus) for load in fingers]
        linear = self.body.deform(*_joined(loads), 1.0)
        if isinstance(self.shape, LinearShape) or not loads:
            return Met(linear, linear, 0.0)
        wanted = self._places(loads, linear)
        self._recognise(loads, wanted)
        displacements = self._shape(loads)
        now = self._places(loads, displacements)
        missed = wanted - now
        resultants = np.array([load.forces.sum(axis=0) for load in loads]) + self._added
        self._learn(resultants, now)
        share = _longest(missed) / max(_longest(wanted), 1e-12)
        if self._gave_up is not None:
            if _longest(wanted - self._gave_up) <= MOVED_ON * _longest(wanted):
                return Met(displacements, linear, 0.0)
            self._gave_up, self._trust, self._best = None, LARGEST_STEP, None
        self._judge(share)
        if share > MET:
            self._approach(loads, missed, wanted)
        return Met(displacements, linear, share)

    def settle(self, loads: Sequence[FingerLoad], young_modulus: float) -> Met:
        """Steps until the fingers are met, or as many as help."""
        best = self.step(loads, young_modulus)
        for _ in range(MOST_STEPS):
            if best.settled:
                break
            met = self.step(loads, young_modulus)
            best = min((best, met), key=lambda one: one.missed)
        return best

    def _recognise(self, loads: Sequence[FingerLoad], wanted: Array) -> None:
        """Begin anew with other fingers; go on where the same ones have moved over the surface."""
        fingers = tuple(tuple(load.nodes.tolist()) for load in loads)
        if fingers == self._fingers:
            return
        if len(fingers) != len(self._fingers):
            self._added = np.zeros((len(loads), 3))
            # Per metre, what the linear relation says in the mean: enough to begin with.
            forces = [float(np.linalg.norm(load.forces.sum(axis=0))) for load in loads]
            ways = np.maximum(np.linalg.norm(wanted, axis=1), 1e-12)
            self._inverse = np.diag(np.repeat(np.array(forces) / ways, 3))
        self._fingers, self._before, self._gave_up = fingers, None, None
        self._trust, self._best = LARGEST_STEP, None

    def _shape(self, loads: Sequence[FingerLoad]) -> Array:
        changed = [
            FingerLoad(load.nodes, load.forces + load.weights[:, None] * added)
            for load, added in zip(loads, self._added, strict=True)
        ]
        return self.shape.displacements(*_joined(changed), 1.0)

    def _places(self, loads: Sequence[FingerLoad], displacements: Array) -> Array:
        """How far the middle of each load moves, (m, 3)."""
        ways = np.zeros((len(loads), 3))
        for number, load in enumerate(loads):
            free = self.body.free_index(load.nodes)
            moves = free >= 0
            ways[number] = load.weights[moves] @ displacements[free[moves]]
        return ways

    def _learn(self, resultants: Array, places: Array) -> None:
        """Broyden's update of the inverse: loads per displacement, from the last two shapes."""
        before, self._before = self._before, (resultants.copy(), places.copy())
        if before is None:
            return
        loads, ways = (resultants - before[0]).ravel(), (places - before[1]).ravel()
        if np.linalg.norm(ways) <= 1e-4 * np.linalg.norm(places):
            # Too little to tell from rounding.
            return
        through = self._inverse @ ways
        along = float(loads @ through)
        if abs(along) > 1e-3 * float(np.linalg.norm(loads) * np.linalg.norm(through)):
            change: Array = np.outer((loads - through) / along, loads @ self._inverse)
            self._inverse = self._inverse + change

    def _judge(self, share: float) -> None:
        """Trust larger steps where they help, smaller ones where they do not."""
        if self._best is None or share < 0.98 * self._best[0]:
            self._trust = LARGEST_STEP if self._best is None else min(LARGEST_STEP, 2 * self._trust)
            self._best = (share, self._added)
        elif share > LITTLE:
            self._trust *= 0.5

    def _approach(self, loads: Sequence[FingerLoad], missed: Array, wanted: Array) -> None:
        largest = _longest(np.array([load.forces.sum(axis=0) for load in loads]))
        change = (self._inverse @ missed.ravel()).reshape(-1, 3)
        size = _longest(change)
        if size > self._trust * largest:
            change *= self._trust * largest / size
        added = self._added + change
        within = np.isfinite(added).all() and np.abs(added).max() <= LARGEST_LOAD * largest
        if within and self._trust >= LEAST_STEP:
            self._added = added
            return
        # What came nearest is drawn then, until the fingers move on.
        nearest = np.zeros_like(added) if self._best is None else self._best[1]
        self._added, self._before, self._gave_up = nearest, None, wanted


def settled(body: SoftBody, shape: Shape, loads: Sequence[FingerLoad], young_modulus: float) -> Met:
    """The shape that meets these fingers, with all that it needs; waits for it.

    Raises
    ------
    PalpateError
        It cannot be computed.
    """
    shape.wait_for(np.unique(_joined(loads)[0]))
    return Meeting(body, shape).settle(loads, young_modulus)


def _longest(vectors: Array) -> float:
    """Length of the longest of vectors (m, 3); 0 without any."""
    return float(np.linalg.norm(vectors, axis=1).max(initial=0.0))


def _joined(loads: Sequence[FingerLoad]) -> tuple[NDArray[np.int64], Array]:
    nodes = [load.nodes for load in loads]
    forces = [load.forces for load in loads]
    return (
        np.concatenate([np.zeros(0, dtype=np.int64), *nodes]),
        np.concatenate([np.zeros((0, 3)), *forces]),
    )
