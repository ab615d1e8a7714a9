"""Cores that this process may use, and those of them that are idle."""

from __future__ import annotations

import os
import sys

import psutil

# Time of observation: several of the system's clock ticks, which are hundredths of a second.
LOOK_SECONDS = 0.1


def available_cores() -> int:
    """Cores this process is allowed to run on, at least 1.

    Fewer than the machine has where a scheduler or ``taskset`` confines the process. A container's
    share of time is not counted.
    """
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def idle_cores() -> int:
    """Cores this process may use that are idle at the moment, at least 1.

    Measured over a tenth of a second, in which this thread sleeps. The load average would count
    this process's own work of the last minute.
    """
    cores = available_cores()
    if cores == 1:
        return 1
    busy = [percent / 100 for percent in psutil.cpu_percent(LOOK_SECONDS, percpu=True)]
    if sys.platform == "linux" and (allowed := os.sched_getaffinity(0)) <= set(range(len(busy))):
        busy = [busy[core] for core in allowed]
    return max(1, min(cores, round(len(busy) - sum(busy))))
