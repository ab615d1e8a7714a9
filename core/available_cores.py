"""How many of the machine's cores this process may use."""

from __future__ import annotations

import os
import sys


def available_cores() -> int:
    """Cores this process is allowed to run on, at least 1.

    Fewer than the machine has where a scheduler or ``taskset`` confines the process. A container's
    share of time is not counted.
    """
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
