"""Where it is known how firm a body is: presses that were looked at, for those that come back."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from .finger_load import FingerLoad, are_near
from .pressed import Firmness, through

# So many are remembered, the last ones.
MOST = 48
# Of energies of a place that differ by a smaller factor the last found is kept; so many at most.
APART, MOST_ENERGIES = 1.3, 24


@dataclass(frozen=True, eq=False)
class FirmPlaces:
    """Presses of one body with what was found of them."""

    _known: deque[tuple[tuple[FingerLoad, ...], Firmness]] = field(
        default_factory=lambda: deque(maxlen=MOST)
    )

    def remember(self, loads: tuple[FingerLoad, ...], firmness: Firmness) -> None:
        """What was found of a press."""
        self._known.append((loads, firmness))

    def at(self, loads: Sequence[FingerLoad]) -> Firmness:
        """All that is known of presses there by the same fingers; where there is none, linear."""
        points: list[tuple[float, float]] = []
        for known, found in reversed(self._known):
            if not are_near(known, loads):
                continue
            points += [
                (energy, share)
                for energy, share in zip(found.energies, found.shares, strict=True)
                if all(not 1.0 / APART < energy / other < APART for other, _ in points)
            ]
        return through(sorted(points)[-MOST_ENERGIES:])

    def forget(self) -> None:
        """All of them: the body is another one."""
        self._known.clear()
