"""How many threads BLAS works with, set within the process for as long as a piece of work lasts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache

import scipy.linalg.blas  # noqa: F401 - loads the library that is to be found
from threadpoolctl import ThreadpoolController

from .available_cores import available_cores, idle_cores

# Floating point operations from which on threads are worth waking: ten milliseconds of one. Below,
# and most of all beside other busy programs, they spend more time on waiting for one another.
LEAST_FLOPS_FOR_THREADS = 5e8


@contextmanager
def blas_threads(wanted: int | None = None) -> Iterator[int]:
    """Let BLAS use ``wanted`` threads, or as many as there are idle cores for this process if None.

    Never more than those cores: threads that wait for one another's core make products slower than
    one thread alone. Cores that other programs keep busy count as much: beside them two threads
    were measured to take three times as long as one. Yields the number; what was set before holds
    again afterwards. All of a process shares it.
    """
    count = idle_cores() if wanted is None else min(wanted, available_cores())
    with _controller().limit(limits=count, user_api="blas"):
        yield count


@contextmanager
def threads_by_work() -> Iterator[Callable[[float], None]]:
    """Let BLAS use its threads for large pieces of work only, and one for small ones.

    Yields a function to be told the floating point operations that come next.
    """
    libraries = [
        (library, library.num_threads)
        for library in _controller().lib_controllers
        if library.user_api == "blas" and library.num_threads > 1
    ]
    threaded = True

    def suit(flops: float) -> None:
        nonlocal threaded
        if threaded != (flops >= LEAST_FLOPS_FOR_THREADS):
            threaded = not threaded
            for library, count in libraries:
                library.set_num_threads(count if threaded else 1)

    try:
        yield suit
    finally:
        suit(LEAST_FLOPS_FOR_THREADS)


@cache
def _controller() -> ThreadpoolController:
    """Of the libraries loaded by now; finding them takes a millisecond."""
    return ThreadpoolController()
