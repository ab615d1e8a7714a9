"""Progress of a bake: its steps weighted by their expected time."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ..progress import Progress

# (step, share of the bake done, or None if unknown)
BakeProgress = Callable[[str, float | None], None]
# (step that reports nothing itself, share of the bake done at its end, its expected seconds)
Foresight = Callable[[str, float, float], None]


class BakeWork:
    """Share of the bake done, from the progress of each step.

    The expected time of a step is known once there are tetrahedra, and better once the elimination
    is planned. The share never falls.

    Parameters
    ----------
    report : called with step and share; an exception from it cancels the bake.
    """

    def __init__(self, report: BakeProgress) -> None:
        self._report = report
        self._weights: dict[str, float] = {}
        self._done = 0.0
        self._step = ""
        self._share = 0.0

    def unknown(self, step: str) -> None:
        """Begin a step of unknown duration."""
        self._report(step, None)

    def expect(self, seconds: Mapping[str, float], spent: float = 0.0) -> None:
        """Set or correct the expected seconds of coming steps; ``spent`` are seconds elapsed."""
        self._weights |= seconds
        self._done += spent

    def forget(self, step: str) -> None:
        """Drop an expected step."""
        self._weights.pop(step, None)

    def until_end_of(self, step: str) -> float:
        """Share of the bake done once an expected first step has ended."""
        total = self._done + sum(self._weights.values())
        return (self._done + self._weights[step]) / total if total > 0 else 0.0

    def begin(self, step: str) -> Progress:
        """Begin an expected step, and end the one before; returns its progress callback."""
        self._done += self._weights.pop(self._step, 0.0)
        self._step = step
        self.within(0.0)
        return self.within

    def within(self, share: float) -> None:
        """Set the share of the present step done, 0 to 1."""
        done = self._done + share * self._weights.get(self._step, 0.0)
        total = self._done + sum(self._weights.values())
        self._share = max(self._share, min(1.0, done / total) if total > 0 else 0.0)
        self._report(self._step, self._share)
