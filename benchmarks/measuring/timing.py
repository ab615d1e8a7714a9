"""Stopwatches, and the machine's own speed to compare with."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dgemm


def times_seconds(
    work: Callable[[], object], repeats: int, *, warm_up: int = 1
) -> NDArray[np.float64]:
    """Seconds of each of ``repeats`` calls, (repeats,); ``warm_up`` calls before do not count."""
    for _ in range(warm_up):
        work()
    times = np.empty(repeats)
    for index in range(repeats):
        start = time.perf_counter_ns()
        work()
        times[index] = time.perf_counter_ns() - start
    return times * 1e-9


def median_seconds(work: Callable[[], object], repeats: int, *, warm_up: int = 1) -> float:
    """Median time of a call in seconds."""
    return float(np.median(times_seconds(work, repeats, warm_up=warm_up)))


def seconds_of(work: Callable[[], object]) -> float:
    """Time of a single call in seconds, for what takes too long to repeat."""
    return float(times_seconds(work, 1, warm_up=0)[0])


def dgemm_rate(size: int = 1536, repeats: int = 5) -> float:
    """Floating point operations a second of the best of some square products of this ``size``.

    scipy's BLAS, with as many threads as it is set to use.
    """
    rng = np.random.default_rng(1)
    left, right = (np.asfortranarray(rng.normal(size=(size, size))) for _ in range(2))
    result = np.zeros((size, size), order="F")
    fastest = times_seconds(
        lambda: dgemm(1.0, left, right, beta=0.0, c=result, overwrite_c=True), repeats
    ).min()
    return 2.0 * size**3 / float(fastest)
