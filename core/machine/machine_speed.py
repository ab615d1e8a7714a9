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


@cache
def dgemm_rate(threads: int | None = None) -> float:
    """Floating point operations a second of BLAS's matrix product.

    Measured at the first call, which takes some hundredths of a second, and remembered.

    Parameters
    ----------
    threads : of BLAS; None for one on each idle core.
    """
    with blas_threads(threads):
        factor = np.asfortranarray(np.random.default_rng(1999).random((SIZE, SIZE)))
        dgemm(1.0, factor, factor)
        return float(2 * SIZE**3 / min(_seconds_of_product(factor) for _ in range(RUNS)))


def _seconds_of_product(factor: NDArray[np.float64]) -> float:
    start = time.perf_counter()
    dgemm(1.0, factor, factor)
    return time.perf_counter() - start
