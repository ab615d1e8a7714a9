"""Progress callback of long work."""

from __future__ import annotations

from collections.abc import Callable

# Share of a piece of work that is done, 0 to 1.
Progress = Callable[[float], None]


def unwatched(*_: object) -> None:
    """Progress callback that does nothing."""
