"""Progress of long work on standard error: one line that is replaced, or now and then another."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

from ...core.bake.job import JobProgress

CLEAR_LINE = "\r\x1b[K"
# Where no terminal replaces lines, as in a log.
SECONDS_BETWEEN_LINES = 20.0
LONGEST_AS_SECONDS = 2 * 60
LONGEST_AS_MINUTES = 2 * 3600


class StatusLine:
    """Line about work under way; made by :func:`status_line`."""

    def __init__(self) -> None:
        self._told = time.monotonic()

    def show(self, text: str) -> None:
        """Replace the line on a terminal; elsewhere write another one if the last is old."""
        if sys.stderr.isatty():
            print(f"{CLEAR_LINE}{text}", end="", file=sys.stderr, flush=True)
        elif text and time.monotonic() - self._told >= SECONDS_BETWEEN_LINES:
            self._told = time.monotonic()
            print(f"palpate: {text}", file=sys.stderr, flush=True)

    def clear(self) -> None:
        """Clear the line before other output."""
        self.show("")


@contextmanager
def status_line() -> Iterator[StatusLine]:
    """A line that is cleared when the block ends."""
    line = StatusLine()
    try:
        yield line
    finally:
        line.clear()


def bake_status(progress: JobProgress) -> str:
    """Step, share, elapsed and remaining time in words."""
    parts: list[str] = [progress.text]
    if progress.share is not None:
        parts[0] += f" {100 * progress.share:.0f} %"
    parts.append(duration(progress.seconds))
    if progress.remaining is not None:
        parts.append(f"about {duration(progress.remaining)} left")
    return ", ".join(parts)


def duration(seconds: float) -> str:
    """Seconds in readable units: ``12 s``, ``3.5 min``, ``2.2 h``."""
    if seconds < LONGEST_AS_SECONDS:
        return f"{seconds:.0f} s"
    if seconds < LONGEST_AS_MINUTES:
        return f"{seconds / 60:.1f} min"
    return f"{seconds / 3600:.1f} h"
