"""Share of a step that reports nothing itself, by the time that it was expected to take."""

from __future__ import annotations

# Of the step, once the expected time has gone by; the rest is approached and never reached.
SHARE_ON_TIME = 0.8


class ForeseenShare:
    """Share of the work done while fTetWild runs, which tells no share; rises at every look."""

    def __init__(self) -> None:
        self._began: float | None = None

    def update(self, now: float, until: float, expected: float) -> float:
        """Share at the time ``now``, s; the step began at the first call, and ends at ``until``.

        Parameters
        ----------
        until : share of the work that is done when the step has ended.
        expected : seconds of the step.
        """
        if self._began is None:
            self._began = now
        return until * foreseen((now - self._began) / max(expected, 1e-9))


def foreseen(times: float) -> float:
    """Share of a step that has taken ``times`` the expected time.

    >>> [round(foreseen(times), 2) for times in (0.0, 0.5, 1.0, 2.0, 10.0)]
    [0.0, 0.4, 0.8, 0.9, 0.98]
    """
    if times <= 1.0:
        return SHARE_ON_TIME * times
    # Slowly, so that it still moves where a busy machine takes many times as long.
    return 1.0 - (1.0 - SHARE_ON_TIME) / times
