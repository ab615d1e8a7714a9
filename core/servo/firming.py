"""A running servo that presses as firmly as a shape says, found in the background."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from palpate_servo import FingerSnapshot, Snapshot

from ..body.soft_body import SoftBody
from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool
from ..rest.support import Floor, Support, as_tool
from ..shape.rotation_strain.finger_load import FingerLoad, Setting, alike
from ..shape.rotation_strain.firm_places import FirmPlaces
from ..shape.rotation_strain.pressed import Firmness
from ..shape.shapes import Shape, pressed_by

# It is looked for deeper than fingers are that move: as deep as they will be in so many times as
# long as the last look took, the first one so many seconds; times the depth, at least and at most,
# but of a pinned body to this share of its size: what nobody holds would weigh as much more.
LOOKS_AHEAD, TAKES = 1.2, 0.1
AHEAD, FARTHEST_AHEAD, REACH = 1.2, 1.6, 0.04
# Fingers whose forces changed by less than this share press as they did; by less than the other
# between two calls, they are at rest.
SAME, AT_REST = 0.03, 1e-6

Array = NDArray[np.float64]

LINEAR = Firmness()


class Firmed(Protocol):
    """A servo, as far as it is told here."""

    def set_firmness(self, energies: Sequence[float], shares: Sequence[float]) -> None:
        """As firmly as :class:`Firmness` says of these."""


@dataclass(frozen=True, eq=False)
class _Look:
    """At what it is looked since ``begun``: loads of a linear body, ``ahead`` times as deep."""

    loads: tuple[FingerLoad, ...] = ()
    ahead: float = 0.0
    begun: float = 0.0


@dataclass(eq=False)
class Firming:
    """Follows a servo's touch. ``tool`` is what all its fingers press with, of a pinned body one
    that slides; of one that nobody holds with ``friction``, and ``supports`` bear it; where a hand
    steadies it, it goes along ``let_go`` (3,) in the world alone. Snapshots are as the body sees
    them (``Snapshot.seen_from_body``).

    Between calls of :meth:`follow` a thread may be at work.

    Firmness is what all looks at a place have found: while fingers move at presses somewhat deeper,
    once they are at rest at the very press, as of one without a clock.
    """

    servo: Firmed
    body: SoftBody
    tool: Tool | None = None
    friction: float = 0.0
    supports: Sequence[Floor | Support] = ()
    let_go: Array | None = None
    _finding: Future[Firmness] | None = None
    _worker: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, "palpate-firmness")
    )
    _told: Firmness = LINEAR
    _shape: Shape | None = None
    _looked: _Look = field(default_factory=_Look)
    _places: FirmPlaces = field(default_factory=FirmPlaces)
    _before: tuple[FingerLoad, ...] = ()
    _seen: Snapshot | None = None
    # How long the last look at fingers that move took, s.
    _took: float = TAKES

    @property
    def looks(self) -> bool:
        """Whether a thread is at work."""
        return self._finding is not None

    def follow(self, snapshot: Snapshot, shape: Shape, young_modulus: float) -> None:
        """Tell the servo what was found, and look anew where the touch has changed. At once.

        Raises
        ------
        PalpateError
            What was looked for cannot be computed.
        """
        loads = self.pressing(snapshot)
        rests, self._before = alike(loads, self._before, AT_REST), loads
        depth, speed = _going(self._seen, snapshot, young_modulus)
        self._seen = snapshot
        is_other, self._shape = shape is not self._shape, shape
        if is_other:
            self._places.forget()
        if not loads or is_other:
            self._looked = _Look()
            self._tell(LINEAR)
        elif self._told == LINEAR:
            self._tell(self._places.at(loads))
        self._hear(snapshot.time)
        if self.looks:
            return
        ahead = 1.0 if rests else self._ahead(depth, speed)
        if not loads or shape.ready < 1.0 or self._knows(loads, ahead):
            return
        if not rests:
            known = self._places.at(loads)
            if known.reach > AHEAD * AHEAD * snapshot.held:
                self._tell(known)
                return
        self._looked = _Look(loads, ahead, snapshot.time)
        self._finding = self._worker.submit(
            _firmness, shape, self._looked, young_modulus, snapshot.held
        )

    def _ahead(self, depth: float, speed: float) -> float:
        """How many times as deep fingers will be by the end of the next look that go on so."""
        if not depth > 0.0:
            return AHEAD
        size = 0.0 if self.body.is_free else float(np.ptp(self.body.mesh.nodes, axis=0).max())
        goal = depth + LOOKS_AHEAD * self._took * speed
        return max(min(goal, max(FARTHEST_AHEAD * depth, REACH * size)) / depth, AHEAD)

    def _hear(self, now: float) -> None:
        """Tell what a look has found that has ended."""
        if self._finding is None or not self._finding.done():
            return
        found, self._finding = self._finding.result(), None
        # What another shape said, or of another touch, is looked for anew.
        if self._looked.loads:
            self._places.remember(self._looked.loads, found)
            self._tell(self._places.at(self._looked.loads))
            if self._looked.ahead > 1.0:
                self._took = now - self._looked.begun

    def pressing(self, snapshot: Snapshot) -> tuple[FingerLoad, ...]:
        """Loads of the fingers that touch, and of what bears the body, as a linear one would have
        them, of one that gives way with time in the end.
        """
        surface, firm = self.body.mesh.surface_nodes, snapshot.firmness
        let_go = self._let_go(Pose(*snapshot.placement))
        loads = [
            FingerLoad(
                surface[finger.nodes],
                self._linear(snapshot, finger.nodes, finger.nodal_forces),
                sticks=not len(finger.points),
                by=self._setting(finger),
                firmness=firm if self.body.is_free else 1.0,
                let_go=let_go,
            )
            for finger in snapshot.fingers
            if finger.touching and len(finger.nodes)
        ]
        if len(snapshot.borne_nodes):
            loads += self._borne(snapshot)
        return tuple(loads)

    def _linear(self, snapshot: Snapshot, nodes: NDArray[np.int64], forces: Array) -> Array:
        """Forces (k, 3), N, of a linear body that is as it is now; in the end, if it remembers."""
        if not len(snapshot.remembered_nodes):
            return forces / snapshot.firmness
        remembered = np.zeros((len(self.body.mesh.surface_nodes), 3))
        remembered[snapshot.remembered_nodes] = snapshot.remembered_forces
        return remembered[nodes]

    def _borne(self, snapshot: Snapshot) -> list[FingerLoad]:
        """Loads of the supports: each of the force on the nodes that are nearest to it."""
        nodes = self.body.mesh.surface_nodes[snapshot.borne_nodes]
        forces = self._linear(snapshot, snapshot.borne_nodes, snapshot.borne_forces)
        if not self.supports:
            return [FingerLoad(nodes, forces)]
        placement = Pose(*snapshot.placement)
        centre = placement.to_world(self.body.inertia.centre)
        size = float(np.ptp(self.body.mesh.nodes, axis=0).max())
        laid = [as_tool(support, centre, size) for support in self.supports]
        by = [(tool, placement.pose_to_tool(pose)) for tool, pose in laid]
        places = self.body.mesh.nodes[nodes]
        away = [tool.distance(pose.to_tool(places))[0] for tool, pose in by]
        nearest, let_go = np.argmin(away, axis=0), self._let_go(placement)
        return [
            FingerLoad(
                nodes[own],
                forces[own],
                by=Setting(*one, self.body, support.friction),
                firmness=snapshot.firmness,
                let_go=let_go,
            )
            for number, (one, support) in enumerate(zip(by, self.supports, strict=True))
            if (own := nearest == number).any()
        ]

    def _setting(self, finger: FingerSnapshot) -> Setting | None:
        if self.tool is None or not len(finger.points):
            return None
        pose = Pose(finger.proxy, finger.orientation)
        return Setting(self.tool, pose, self.body, self.friction)

    def _let_go(self, placement: Pose) -> Array | None:
        return None if self.let_go is None else self.let_go @ placement.rotation

    def close(self) -> None:
        """End; does not wait."""
        self._worker.shutdown(wait=False, cancel_futures=True)

    def _knows(self, loads: Sequence[FingerLoad], ahead: float) -> bool:
        looked = self._looked
        if ahead > 1.0:
            return alike(loads, looked.loads, SAME)
        return looked.ahead == 1.0 and alike(loads, looked.loads, AT_REST)

    def _tell(self, firmness: Firmness) -> None:
        if firmness != self._told:
            self._told = firmness
            told = firmness.going_on()
            self.servo.set_firmness(told.energies, told.shares)


def _going(before: Snapshot | None, now: Snapshot, young_modulus: float) -> tuple[float, float]:
    """How deep fingers are in, m, and how fast they go deeper, m/s: by what they hold and do on a
    linear body, over the forces on them.
    """
    forces = [one.contact_force / (now.firmness * young_modulus) for one in now.fingers]
    pressed = sum(float(np.linalg.norm(force)) for force in forces)
    if not pressed > 0.0:
        return 0.0, 0.0
    depth = 2.0 * now.held / pressed
    if before is None or not now.time > before.time:
        return depth, 0.0
    pairs = zip(forces, now.fingers, before.fingers, strict=False)
    work = -sum(float(force @ (one.probe - was.probe)) for force, one, was in pairs)
    return depth, work / (pressed * (now.time - before.time))


def _firmness(shape: Shape, look: _Look, young_modulus: float, held: float) -> Firmness:
    """Of loads that hold ``held``, J/Pa, as the servo counts it: with the near field."""
    found = pressed_by(shape, look.loads, young_modulus, look.ahead)
    if not (found.energy > 0.0 and held > 0.0):
        return found.firmness
    return found.firmness.times(held / found.energy)
