"""Trials on a computer that may be busy: what it held up is not judged, and tried again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from .host import NotReachedError

ALLOWED_MS = 5.0
"""A guardian waits for 12 ms; what a computer holds up beyond the rest of 20 is not its doing."""
MOST_HELD_UP = 5


class Trial(Protocol):
    """Something that was tried on a computer that may have been busy."""

    @property
    def held_up_ms(self) -> float:
        """How long this computer held up a line that has nothing to do with it."""


T = TypeVar("T", bound=Trial)


@dataclass(frozen=True)
class Trials(Generic[T]):
    """What was tried, without what this computer held up, whatever came of that."""

    judged: tuple[T, ...]
    held_up: int

    @property
    def note(self) -> str:
        """What is said of the others, if anything."""
        return f"{self.held_up} more not judged: computer busy" if self.held_up else ""

    @property
    def unjudged(self) -> tuple[str, ...]:
        """The rule that a row without any judged trial breaks."""
        return () if self.judged else ("this computer was held up: not judged",)


def trials(times: int, once: Callable[[], T]) -> Trials[T]:
    """Try until so many can be judged, or five times as many could not."""
    judged: list[T] = []
    held_up = 0
    while len(judged) < times and held_up <= MOST_HELD_UP * times:
        try:
            one = once()
        except NotReachedError:
            # Nothing was pressed, or the computer was too busy to see it.
            held_up += 1
            continue
        if one.held_up_ms > ALLOWED_MS:
            held_up += 1
        else:
            judged.append(one)
    return Trials(tuple(judged), held_up)
