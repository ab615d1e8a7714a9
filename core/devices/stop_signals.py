"""Being asked to stop: Ctrl-C and termination as something to look at, not an exception."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from types import FrameType

WANTED = (signal.SIGTERM, signal.SIGINT)


@contextlib.contextmanager
def stopped_by_signals() -> Iterator[list[int]]:
    """A list that is empty until somebody asks this process to stop. For the main thread only."""
    received: list[int] = []

    def note(number: int, _frame: FrameType | None) -> None:
        received.append(number)

    before = [signal.signal(number, note) for number in WANTED]
    try:
        yield received
    finally:
        for number, handler in zip(WANTED, before, strict=True):
            signal.signal(number, handler)
