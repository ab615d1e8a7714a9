"""Stop requests, Ctrl-C and SIGTERM, as a value to poll instead of an exception."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from types import FrameType

HANG_UP = getattr(signal, "SIGHUP", None)
WANTED = [number for number in (signal.SIGTERM, signal.SIGINT, HANG_UP) if number is not None]


@contextlib.contextmanager
def stopped_by_signals() -> Iterator[list[int]]:
    """List that stays empty until a stop signal arrives. For the main thread only."""
    received: list[int] = []

    def note(number: int, _frame: FrameType | None) -> None:
        received.append(number)

    # Respect nohup.
    wanted = [number for number in WANTED if number != HANG_UP or not _is_ignored(number)]
    before = {number: signal.signal(number, note) for number in wanted}
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _is_ignored(number: int) -> bool:
    return signal.getsignal(number) is signal.SIG_IGN
