"""Frames of a demo in real time."""

import time
from collections.abc import Callable, Iterator
from typing import Protocol

FRAME_RATE = 60
# How much longer than asked frames go on where what they show has not come, as on a computer that
# stood still a moment before the end: the device is let go then, and pressed again.
PATIENCE = 4.0


class Clock(Protocol):
    """What is asked of the module `time`."""

    def perf_counter(self) -> float:
        """Seconds since some moment."""

    def sleep(self, seconds: float, /) -> None:
        """Wait."""


def frames(seconds: float, has_come: Callable[[], bool], clock: Clock = time) -> Iterator[float]:
    """Yield the time (s) at which each frame begins, FRAME_RATE in a second.

    Frames end after ``seconds`` if what they show has come, and after PATIENCE times that if not.
    """
    start = due = clock.perf_counter()
    while (begun := clock.perf_counter()) - start < seconds or (
        begun - start < PATIENCE * seconds and not has_come()
    ):
        yield begun
        # A frame may have taken longer than its time.
        due = max(due + 1.0 / FRAME_RATE, clock.perf_counter())
        clock.sleep(max(due - clock.perf_counter(), 0.0))
