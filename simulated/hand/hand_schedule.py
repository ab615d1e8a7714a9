"""Schedule of a simulated device: motion of its hand, plug pulled and put back.

Times count from the first host. Until then the hand rests and the plug is in.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from .hand_script import HandScript, TurnScript
from .options import SimulatedOptions
from .plant import Vector
from .quaternion import UPRIGHT, Quaternion


class HandSchedule:
    """Schedule in seconds since power-on; raises PalpateError for bad options."""

    def __init__(self, options: SimulatedOptions) -> None:
        self._script = options.hand_script()
        self._script_begin: float | None = None
        self._turns = options.turn_script(self._script)
        self._turns_begin: float | None = None
        self._host_came_at: float | None = None
        self._unplug_at = math.inf if options.unplug_at is None else options.unplug_at
        self._plug_at = self._unplug_at + options.unplug_for

    def host_came(self, now: float) -> None:
        """Begin, if this is the first host."""
        if self._host_came_at is None:
            self._host_came_at = now
            if self._script_begin is None:
                self._script_begin = now
            if self._turns_begin is None:
                self._turns_begin = now

    def since_host(self, now: float) -> float:
        """Seconds since the first host came; minus infinity before."""
        return -math.inf if self._host_came_at is None else now - self._host_came_at

    def hand(self, now: float, before: float = 0.0) -> Vector:
        """Target of the hand, ``before`` seconds ago."""
        return self._script.at(self._script_time(now) - before)

    def move_hand(self, now: float, position: Vector, seconds: float) -> None:
        """Leave the script: move the hand to `position` and stay."""
        self._script = HandScript((0.0, max(seconds, 1e-6)), (self.hand(now), position))
        self._script_begin = now

    def turned(self, now: float) -> Quaternion | None:
        """Rotation of the stylus; None for a device without orientation."""
        if self._turns is None:
            return None
        return self._turns.at(0.0 if self._turns_begin is None else now - self._turns_begin)

    def turn_hand(self, now: float, rotation: Quaternion, seconds: float) -> None:
        """Leave the script: turn the stylus to `rotation` (unit) and stay."""
        held = self.turned(now) or UPRIGHT
        self._turns = TurnScript((0.0, max(seconds, 1e-6)), (held, rotation))
        self._turns_begin = now

    def keep_plug(
        self, now: float, unplug: Callable[[], None], plug_in: Callable[[], None]
    ) -> None:
        """Pull the plug or put it back, once each, at their times."""
        since = self.since_host(now)
        if since >= self._unplug_at:
            self._unplug_at = math.inf
            unplug()
        if since >= self._plug_at:
            self._plug_at = math.inf
            plug_in()

    def _script_time(self, now: float) -> float:
        return 0.0 if self._script_begin is None else now - self._script_begin
