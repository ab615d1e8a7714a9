"""A running servo that presses as firmly as a shape says, found in the background."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
from palpate_servo import Servo, Snapshot

from ..body.soft_body import SoftBody
from ..shape.rotation_strain.finger_load import FingerLoad
from ..shape.rotation_strain.firmness import Firmness
from ..shape.shapes import Shape, firmness_of

# It is looked for a little deeper than the fingers are: they may go on.
AHEAD = 1.2
# Fingers whose forces changed by less than this share press as they did.
SAME = 0.03

LINEAR = Firmness()


@dataclass(eq=False)
class Firming:
    """Follows a servo's touch; between calls of :meth:`follow` a thread may be at work."""

    servo: Servo
    body: SoftBody
    _finding: Future[Firmness] | None = None
    _worker: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, "palpate-firmness")
    )
    _told: Firmness = LINEAR
    _shape: Shape | None = None
    _looked_at: tuple[FingerLoad, ...] = ()

    def follow(self, snapshot: Snapshot, shape: Shape, young_modulus: float) -> None:
        """Tell the servo what was found, and look anew where the touch has changed. At once.

        Raises
        ------
        PalpateError
            What was looked for cannot be computed.
        """
        loads = pressing(self.body, snapshot)
        is_other, self._shape = shape is not self._shape, shape
        if not loads or is_other:
            self._looked_at = ()
            self._tell(LINEAR)
        if self._finding is not None:
            if not self._finding.done():
                return
            found, self._finding = self._finding.result(), None
            # What another shape said, or of another touch, is looked for anew.
            if self._looked_at:
                self._tell(found)
        if loads and shape.ready == 1.0 and not _alike(loads, self._looked_at):
            self._looked_at = loads
            deeper = [FingerLoad(one.nodes, AHEAD * one.forces, one.sticks) for one in loads]
            self._finding = self._worker.submit(firmness_of, shape, deeper, young_modulus)

    def close(self) -> None:
        """End; does not wait."""
        self._worker.shutdown(wait=False, cancel_futures=True)

    def _tell(self, firmness: Firmness) -> None:
        if firmness != self._told:
            self._told = firmness
            self.servo.set_firmness(firmness.root, firmness.whole, firmness.reach)


def pressing(body: SoftBody, snapshot: Snapshot) -> tuple[FingerLoad, ...]:
    """Loads of the fingers that touch, as a linear body would have them; none of one that gives
    way with time, which presses as a linear one does.
    """
    if len(snapshot.remembered_nodes):
        return ()
    return tuple(
        FingerLoad(
            body.mesh.surface_nodes[finger.nodes],
            finger.nodal_forces / snapshot.firmness,
            sticks=not len(finger.points),
        )
        for finger in snapshot.fingers
        if finger.touching and len(finger.nodes)
    )


def _alike(loads: tuple[FingerLoad, ...], others: tuple[FingerLoad, ...]) -> bool:
    """Whether forces differ by little, on the same nodes."""
    return len(loads) == len(others) and all(
        np.array_equal(one.nodes, other.nodes)
        and np.abs(one.forces - other.forces).sum() <= SAME * np.abs(one.forces).sum()
        for one, other in zip(loads, others, strict=True)
    )
