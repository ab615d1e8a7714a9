"""Number of BLAS threads, set for the duration of a piece of work."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache

import scipy.linalg.blas  # noqa: F401 - loads the library that is to be found
from threadpoolctl import ThreadpoolController

from .available_cores import available_cores, idle_cores

# Floating point operations from which threads pay off: ten milliseconds of one. Below that, and
# even more on a busy machine, they mostly wait for each other.
LEAST_FLOPS_FOR_THREADS = 5e8


@contextmanager
def blas_threads(wanted: int | None = None) -> Iterator[int]:
    """Let BLAS use ``wanted`` threads; if None, one for each idle core.

    Never more than there are idle cores: with oversubscribed cores, two threads were measured to
    take three times as long as one. Yields the number; afterwards the earlier one is restored.
    The setting is the process's.
    """
    count = idle_cores() if wanted is None else min(wanted, available_cores())
    with _controller().limit(limits=count, user_api="blas"):
        yield count


@contextmanager
def threads_by_work() -> Iterator[Callable[[float], None]]:
    """Let BLAS use all its threads for large pieces of work, and one thread for small ones.

    Yields a function that takes the number of floating point operations to come.
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
    """Controller of the libraries loaded so far; finding them takes a millisecond."""
    return ThreadpoolController()
