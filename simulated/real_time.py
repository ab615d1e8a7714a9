"""Real-time priority for what answers a servo or measures one."""

from __future__ import annotations

import os
import sys

PRIORITY = 1


def ask_for_real_time() -> bool:
    """Ask for it for the calling thread, below any servo; whether it is granted."""
    if sys.platform != "linux":
        return False
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(PRIORITY))
    except PermissionError:
        return False
    return True
