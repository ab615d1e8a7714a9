"""Where it is known how firm a body is: presses that were looked at, for those that come back."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from .finger_load import FingerLoad, are_near
from .pressed import Firmness

# So many are remembered, the last ones.
MOST = 16


@dataclass(frozen=True, eq=False)
class _Known:
    loads: tuple[FingerLoad, ...]
    firmness: Firmness


@dataclass(frozen=True, eq=False)
class FirmPlaces:
    """Presses of one body with what was found of them."""

    _known: deque[_Known] = field(default_factory=lambda: deque(maxlen=MOST))

    def remember(self, loads: tuple[FingerLoad, ...], firmness: Firmness) -> None:
        """What was found of a press."""
        self._known.append(_Known(loads, firmness))

    def at(self, loads: Sequence[FingerLoad]) -> Firmness:
        """That of the deepest press there by the same fingers; where there is none a linear one."""
        there = (known.firmness for known in self._known if are_near(known.loads, loads))
        return max(there, key=lambda firmness: firmness.reach, default=Firmness())

    def forget(self) -> None:
        """All of them: the body is another one."""
        self._known.clear()
