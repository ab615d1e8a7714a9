"""Estimate of the time left, from the progress so far."""

from __future__ import annotations

# Least time (s) and share of the work before a rate is more than a guess.
FIRST_SECONDS = 0.5
FIRST_SHARE = 0.02

# Time constant (s) of smoothing, so that the figure does not jump.
SMOOTHING_SECONDS = 2.0


class RemainingTime:
    """Seconds left, from a sequence of shares done; counts down between two of them."""

    def __init__(self) -> None:
        self._first: tuple[float, float] | None = None
        self._newest = (0.0, 0.0)
        self._remaining: float | None = None
        self._updated_at = 0.0

    def update(self, seconds: float, share: float | None) -> float | None:
        """Seconds that remain when ``share`` is done after ``seconds``; None if unknown yet."""
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
        return self._remaining
