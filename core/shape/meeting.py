"""Loads under which a large-deformation shape meets the fingers that press it.

The force that is felt comes from the linear relation, under which the linear shape moves exactly as
the fingers do. Under the same force another shape moves its touched places elsewhere: the bend of
an ear goes along an arc. What is drawn shall touch the finger; so each finger's load is changed by
a force c, shared by its nodes as the load itself is, until the touched place is where the linear
shape has it. Broyden's method finds c; between two frames it goes on where it was. It begins with
the softest stiffness of the place in all directions: a body gives way where it is soft, and a
finger that goes where the body could only be torn to is met as nearly as the body bends.

Reference
---------
C. G. Broyden: A class of methods for solving nonlinear simultaneous equations, Mathematics of
Computation 19 (1965), 577-593.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from .rotation_strain.finger_load import FingerLoad, joined, let_go
from .shapes import LinearShape, Shape, pressed_by

Array = NDArray[np.float64]

# A place is met when it is missed by less than this share of its way. To miss it by little is no
# sign that steps do not help.
MET, LITTLE = 0.01, 0.05
# A step goes no farther than this share of the body's size; that is halved where steps bring
# nothing, and below the least the fingers cannot be met.
LARGEST_STEP, LEAST_STEP = 0.03, 0.002
# Nor does it change the loads by more than this share of the largest one.
LARGEST_CHANGE = 0.3
# Fingers that moved by this share of their way are followed again.
MOVED_ON = 0.05
# The nodes of a load whose compliance is looked up, at most.
MOST_NODES = 12
# Steps when somebody waits for the answer.
MOST_STEPS = 60


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
    _nodes: tuple[tuple[int, ...], ...] = ()
    _loads: Array = field(default_factory=lambda: np.zeros((0, 3)))
    _stiffness: Array = field(default_factory=lambda: np.zeros((0, 0)))
    _wanted: Array | None = None
    _before: tuple[Array, Array] | None = None
    # The way of one step, as a share of the body's size, and the least that was missed since the
    # fingers moved: by how much, with which loads, for which places.
    _trust: float = LARGEST_STEP
    _best: tuple[float, Array, Array] | None = None
    _gave_up: bool = False

    def step(self, fingers: Sequence[FingerLoad], young_modulus: float) -> Met:
        """The shape under these loads, one step nearer to the fingers than the last one."""
        loads = [FingerLoad(load.nodes, load.forces / young_modulus) for load in fingers]
        linear = self.body.deform(*joined(loads), 1.0)
        if isinstance(self.shape, LinearShape) or not loads:
            return Met(linear, linear, 0.0)
        if self.body.is_free:
            # As a whole it is where what touches it is.
            moved = self.shape.displacements(*joined(loads), 1.0, let_go(fingers))
            return Met(moved, linear, 0.0)
        wanted = self._places(loads, linear)
        self._recognise(loads, wanted)
        if self._wanted is not None and not self._gave_up:
            self._approach(wanted - self._wanted)
        self._wanted = wanted
        displacements = self._shape(loads)
        now = self._places(loads, displacements)
        missed = wanted - now
        share = _longest(missed) / max(_longest(wanted), 1e-12)
        self._learn(now)
        rests = self._gave_up
        self._judge(share, wanted)
        if share > MET and not self._gave_up:
            self._approach(missed)
        return Met(displacements, linear, 0.0 if rests and self._gave_up else share)

    def settle(self, loads: Sequence[FingerLoad], young_modulus: float) -> Met:
        """Steps until the fingers are met, or as many as help."""
        best = self.step(loads, young_modulus)
        for _ in range(MOST_STEPS):
            if best.settled:
                break
            met = self.step(loads, young_modulus)
            best = met if met.missed <= best.missed else best
        return best

    def _recognise(self, loads: Sequence[FingerLoad], wanted: Array) -> None:
        """Begin anew with other fingers; go on where the same ones have moved over the surface."""
        nodes = tuple(tuple(load.nodes.tolist()) for load in loads)
        if nodes == self._nodes:
            return
        if len(nodes) != len(self._nodes):
            softest = np.array([self._softest(load) for load in loads])
            self._loads, self._wanted = softest[:, None] * wanted, None
            self._stiffness = np.diag(np.repeat(softest, 3))
        self._nodes, self._before, self._best = nodes, None, None
        self._trust, self._gave_up = LARGEST_STEP, False

    @cached_property
    def _size(self) -> float:
        """Diagonal of the body's bounding box, metres."""
        return float(np.linalg.norm(np.ptp(self.body.mesh.nodes, axis=0)))

    def _softest(self, load: FingerLoad) -> float:
        """Load per way of the middle of a load in its softest direction, by the linear relation.

        Steps by this are safe in every direction, where the stiffness itself, once the place has
        turned, would ask for too much. Large deformations go along the soft ones.
        """
        heaviest = np.argsort(-load.weights, kind="stable")[:MOST_NODES]
        weights = load.weights[heaviest] / load.weights[heaviest].sum()
        local = np.searchsorted(self.body.mesh.surface_nodes, load.nodes[heaviest])
        blocks = self.body.surface_blocks(local, local)
        compliance = np.einsum("a,b,abij->ij", weights, weights, blocks)
        return 1.0 / float(np.linalg.eigvalsh(0.5 * (compliance + compliance.T))[-1])

    def _shape(self, loads: Sequence[FingerLoad]) -> Array:
        changed = [
            FingerLoad(
                load.nodes, load.forces + load.weights[:, None] * (now - load.forces.sum(axis=0))
            )
            for load, now in zip(loads, self._loads, strict=True)
        ]
        return self.shape.displacements(*joined(changed), 1.0)

    def _places(self, loads: Sequence[FingerLoad], displacements: Array) -> Array:
        """Displacement of the middle of each load, (m, 3)."""
        ways = np.zeros((len(loads), 3))
        for number, load in enumerate(loads):
            free = self.body.free_index(load.nodes)
            moves = free >= 0
            ways[number] = load.weights[moves] @ displacements[free[moves]]
        return ways

    def _learn(self, places: Array) -> None:
        """Broyden's update of the stiffness, from the last two shapes."""
        before, self._before = self._before, (self._loads, places)
        if before is None:
            return
        loads, ways = (self._loads - before[0]).ravel(), (places - before[1]).ravel()
        if np.linalg.norm(ways) <= 1e-4 * np.linalg.norm(places):
            # Too little to tell from rounding.
            return
        through = self._stiffness @ ways
        along = float(loads @ through)
        if abs(along) > 1e-3 * float(np.linalg.norm(loads) * np.linalg.norm(through)):
            change: Array = np.outer((loads - through) / along, loads @ self._stiffness)
            self._stiffness = self._stiffness + change

    def _judge(self, share: float, wanted: Array) -> None:
        """Trust larger steps where they help, smaller ones where they do not."""
        best = self._best
        moved_on = best is None or _longest(wanted - best[2]) > MOVED_ON * _longest(wanted)
        if best is None or moved_on or share < 0.98 * best[0]:
            self._trust = LARGEST_STEP if moved_on else min(LARGEST_STEP, 2 * self._trust)
            self._best, self._gave_up = (share, self._loads, wanted), False
        elif share > LITTLE and not self._gave_up:
            self._trust *= 0.5
            if self._trust < LEAST_STEP:
                # What came nearest is drawn then, until the fingers move on.
                self._loads, self._before, self._gave_up = best[1], None, True

    def _approach(self, missed: Array) -> None:
        within = min(1.0, self._trust * self._size / max(_longest(missed), 1e-12))
        change = (self._stiffness @ (within * missed).ravel()).reshape(-1, 3)
        most = LARGEST_CHANGE * self._trust / LARGEST_STEP * _longest(self._loads)
        if (size := _longest(change)) > most > 0.0:
            change *= most / size
        if np.isfinite(change).all():
            self._loads = self._loads + change


def settled(body: SoftBody, shape: Shape, loads: Sequence[FingerLoad], young_modulus: float) -> Met:
    """The shape that meets these fingers, with all that it needs; waits for it.

    Where the body comes to rest as deep as they are, led there by forces as theirs, it is that.

    Raises
    ------
    PalpateError
        It cannot be computed.
    """
    nodes, forces = joined(loads)
    shape.wait_for(np.unique(nodes))
    rest = pressed_by(shape, loads, young_modulus).displacements
    if rest is not None:
        return Met(rest, body.deform(nodes, forces, young_modulus), 0.0)
    return Meeting(body, shape).settle(loads, young_modulus)


def _longest(vectors: Array) -> float:
    """Length of the longest of vectors (m, 3); 0 without any."""
    return float(np.linalg.norm(vectors, axis=1).max(initial=0.0))
