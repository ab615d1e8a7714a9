"""The servo's counters, looked up as often as a person reads them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...core.servo.session import Servo

if TYPE_CHECKING:
    from ...core.servo.session import ServoCounters

SECONDS_BETWEEN = 0.5


@dataclass(eq=False)
class LoopFigures:
    """``counters`` as they were last looked up, None before the first time."""

    counters: ServoCounters | None = None
    _looked_at: float = 0.0

    def look(self, servo: Servo, now: float) -> None:
        """Look again, if it is time; ``now`` in s, of any clock."""
        if self.counters is None or now - self._looked_at >= SECONDS_BETWEEN:
            self.counters, self._looked_at = servo.counters(), now
