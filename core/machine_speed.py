"""How fast this machine multiplies matrices, which is what most of a bake's time goes into."""

from __future__ import annotations

import time
from functools import cache

import numpy as np
from scipy.linalg.blas import dgemm

# Large enough to run at full speed, small enough to be measured in some hundredths of a second.
SIZE = 640
RUNS = 3


@cache
def dgemm_rate() -> float:
    """Floating point operations a second of BLAS's matrix product, with the threads it uses now.

    Measured at the first call, some hundredths of a second, and remembered.
    """
    factor = np.asfortranarray(np.random.default_rng(1999).random((SIZE, SIZE)))
    dgemm(1.0, factor, factor)
    fastest = min(_seconds_of_product(factor) for _ in range(RUNS))
    return float(2 * SIZE**3 / fastest)


def _seconds_of_product(factor: np.ndarray) -> float:
    start = time.perf_counter()
    dgemm(1.0, factor, factor)
    return time.perf_counter() - start
