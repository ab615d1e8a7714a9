"""The largest memory that a piece of work takes, as the system sees it."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import ParamSpec, TypeVar

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")

STATUS = Path("/proc/self/status")
CLEAR_REFERENCES = Path("/proc/self/clear_refs")
FORGET_PEAK = "5"


def in_fresh_process(
    work: Callable[Parameters, Result],
    *arguments: Parameters.args,
    **options: Parameters.kwargs,
) -> tuple[Result, int]:
    """What ``work`` returns in a new process, and the bytes its memory grew by at most.

    A process that has worked before keeps freed memory and would hide part of the growth. ``work``
    must be a function of a module, or of a script that is guarded by its name.
    """
    fresh = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(max_workers=1, mp_context=fresh) as process:
        return process.submit(with_peak, partial(work, *arguments, **options)).result()


def with_peak(work: Callable[[], Result]) -> tuple[Result, int]:
    """What ``work`` returns, and the bytes this process grew by at most meanwhile."""
    before = _reset_peak()
    result = work()
    return result, _peak() - before


def _reset_peak() -> int:
    """Resident bytes now. On Linux the peak starts anew from there."""
    if sys.platform != "linux":
        return _peak()
    # Not getrusage: its peak includes what the process was before it became Python.
    CLEAR_REFERENCES.write_text(FORGET_PEAK, encoding="ascii")
    return _status_bytes("VmRSS")


def _peak() -> int:
    if sys.platform == "linux":
        return _status_bytes("VmHWM")
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def _status_bytes(field: str) -> int:
    lines = STATUS.read_text(encoding="ascii").splitlines()
    line = next(line for line in lines if line.startswith(field + ":"))
    return 1024 * int(line.split()[1])
