"""Counters of the servo, refreshed at a readable rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...core.servo.session import Servo

if TYPE_CHECKING:
    from ...core.servo.session import ServoCounters

SECONDS_BETWEEN = 0.5


@dataclass(eq=False)
class LoopFigures:
    """Latest ``counters``, None before the first refresh."""

    counters: ServoCounters | None = None
    _looked_at: float = 0.0

    def look(self, servo: Servo, now: float) -> None:
        """Refresh if it is time; ``now`` in s, of any clock."""
        if self.counters is None or now - self._looked_at >= SECONDS_BETWEEN:
            self.counters, self._looked_at = servo.counters(), now
