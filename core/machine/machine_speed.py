"""Speed of matrix products on this machine, which decides how long a bake takes."""

from __future__ import annotations

import time
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dgemm

from .blas_threads import blas_threads

# Large enough for full speed, small enough for some hundredths of a second.
SIZE = 640
RUNS = 3
# Of the clock's time, what a busy machine leaves to a product at least.
SHORTEST_SHARE = 0.05


@cache
def dgemm_rate(threads: int | None = None) -> float:
    """Floating point operations a second of BLAS's matrix product.

    Measured at the first call, which takes some hundredths of a second, and remembered: what the
    machine can do where nothing else runs.

    Parameters
    ----------
    threads : of BLAS; None for one on each idle core.
    """
    with blas_threads(threads) as count:
        factor = np.asfortranarray(np.random.default_rng(1999).random((SIZE, SIZE)))
        dgemm(1.0, factor, factor)
        return float(2 * SIZE**3 / min(_seconds_of_product(factor, count) for _ in range(RUNS)))


def _seconds_of_product(factor: NDArray[np.float64], threads: int) -> float:
    """By the clock, or by the processor where others took it away meanwhile."""
    clock, processor = time.perf_counter(), time.process_time()
    dgemm(1.0, factor, factor)
    clock, processor = time.perf_counter() - clock, time.process_time() - processor
    # Some systems count a processor's time in steps as long as a product.
    return min(clock, max(processor / threads, SHORTEST_SHARE * clock))
