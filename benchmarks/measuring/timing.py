"""Stopwatches."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray


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
