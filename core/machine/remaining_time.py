"""Estimate of the time left, from the progress so far."""

from __future__ import annotations

import math

# Least time (s) and share of the work before a rate is more than a guess.
FIRST_SECONDS = 0.5
FIRST_SHARE = 0.02

# Time constant (s) of smoothing, so that the figure does not jump.
SMOOTHING_SECONDS = 2.0

# What is told never rises: it stands still while the estimate is at most this many times as long,
# and beyond nothing is told until the estimate has fallen to this share of its largest.
LATE, KNOWN_AGAIN = 2.0, 0.8


class RemainingTime:
    """Seconds left, from a sequence of shares done; counts down between two of them."""

    def __init__(self) -> None:
        self._first: tuple[float, float] | None = None
        self._newest = (0.0, 0.0)
        self._remaining: float | None = None
        self._updated_at = 0.0
        self._told: float | None = None
        # Of the estimates while nothing is told.
        self._longest = math.inf

    def update(self, seconds: float, share: float | None) -> float | None:
        """Seconds that remain when ``share`` is done after ``seconds``; None while unknown."""
        if share is None:
            return None
        if self._first is None:
            self._first = self._newest = (seconds, share)
        if share > self._newest[1]:
            self._newest = (seconds, share)
        (began, at_first), (then, at_newest) = self._first, self._newest
        if then - began < FIRST_SECONDS or at_newest - at_first < FIRST_SHARE:
            return None
        rate = (at_newest - at_first) / (then - began)
        estimate = max(0.0, (1.0 - at_newest) / rate - (seconds - then))
        if self._remaining is None:
            self._remaining = estimate
        else:
            passed = seconds - self._updated_at
            counted_down = max(0.0, self._remaining - passed)
            weight = min(1.0, passed / SMOOTHING_SECONDS)
            self._remaining = counted_down + weight * (estimate - counted_down)
        self._updated_at = seconds
        self._told = self._to_tell(self._remaining)
        return self._told

    def _to_tell(self, estimate: float) -> float | None:
        """What is told of an estimate, after what was told before."""
        if self._told is None:
            self._longest = max(self._longest, estimate)
            return estimate if estimate <= KNOWN_AGAIN * self._longest else None
        if estimate > max(LATE * self._told, FIRST_SECONDS):
            self._longest = estimate
            return None
        return min(self._told, estimate)
