"""Status line on a terminal for long work."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from ...core.bake.job import JobProgress

CLEAR_LINE = "\r\x1b[K"
LONGEST_AS_SECONDS = 2 * 60
LONGEST_AS_MINUTES = 2 * 3600


@contextmanager
def status_line() -> Iterator[None]:
    """Clear the line of :func:`show` when the block ends."""
    try:
        yield
    finally:
        clear()


def show(text: str) -> None:
    """Replace the line, if standard error is a terminal."""
    if sys.stderr.isatty():
        print(f"{CLEAR_LINE}{text}", end="", file=sys.stderr, flush=True)


def clear() -> None:
    """Clear the line before other output."""
    show("")


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
