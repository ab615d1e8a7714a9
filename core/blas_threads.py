"""How many threads BLAS works with, set within the process for as long as a piece of work lasts."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import ThreadpoolController

from .available_cores import available_cores


@contextmanager
def blas_threads(wanted: int | None = None) -> Iterator[int]:
    """Let BLAS use ``wanted`` threads, or as many as there are cores for this process if None.

    Never more than those cores: threads that wait for one another's core make products slower than
    one thread alone. Yields the number; what was set before holds again afterwards. All of a
    process shares it.
    """
    count = min(wanted or available_cores(), available_cores())
    with ThreadpoolController().limit(limits=count, user_api="blas"):
        yield count
