"""How much of a bake is done: the shares of its steps, weighed by the time each will take."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ..progress import Progress

# (step, share of the whole bake done or None where nobody can know)
BakeProgress = Callable[[str, float | None], None]


class BakeWork:
    """Tells a listener the share of the whole, from what each step tells of itself.

    What a step will take is known once there are tetrahedra, and better once the elimination is
    planned. The share never falls when it becomes known better.

    Parameters
    ----------
    tell : the listener; an exception out of it cancels the bake.
    """

    def __init__(self, tell: BakeProgress) -> None:
        self._tell = tell
        self._weights: dict[str, float] = {}
        self._done = 0.0
        self._step = ""
        self._share = 0.0

    def unknown(self, step: str) -> None:
        """A step begins of which nobody can know how long it takes."""
        self._tell(step, None)

    def expect(self, seconds: Mapping[str, float], spent: float = 0.0) -> None:
        """Set what the coming steps will take, or correct it; ``spent`` are seconds gone by."""
        self._weights |= seconds
        self._done += spent

    def forget(self, step: str) -> None:
        """A step that was expected is not needed."""
        self._weights.pop(step, None)

    def begin(self, step: str) -> Progress:
        """An expected step begins; the one before is done. Returns what to tell its share to."""
        self._done += self._weights.pop(self._step, 0.0)
        self._step = step
        self.within(0.0)
        return self.within

    def within(self, share: float) -> None:
        """So much of the present step is done, 0 to 1."""
        done = self._done + share * self._weights.get(self._step, 0.0)
        whole = self._done + sum(self._weights.values())
        self._share = max(self._share, min(1.0, done / whole) if whole > 0 else 0.0)
        self._tell(self._step, self._share)
