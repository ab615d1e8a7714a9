"""Child processes that end with this one, however it ends.

On Windows the system sees to that, by a job that closes with the process that holds it. On Linux
a child asks the kernel for it itself (`core/bake/child.py`); elsewhere a time limit has to do.
"""

from __future__ import annotations

import ctypes
import subprocess
import sys
from functools import cache

# winnt.h: the limit, and the class of information that it is set by.
KILL_ON_JOB_CLOSE = 0x2000
EXTENDED_LIMIT_INFORMATION = 9


class _BasicLimits(ctypes.Structure):
    """JOBOBJECT_BASIC_LIMIT_INFORMATION."""

    _fields_ = (
        ("per_process_user_time", ctypes.c_int64),
        ("per_job_user_time", ctypes.c_int64),
        ("limit_flags", ctypes.c_uint32),
        ("minimum_working_set", ctypes.c_size_t),
        ("maximum_working_set", ctypes.c_size_t),
        ("active_process_limit", ctypes.c_uint32),
        ("affinity", ctypes.c_size_t),
        ("priority_class", ctypes.c_uint32),
        ("scheduling_class", ctypes.c_uint32),
    )


class _ExtendedLimits(ctypes.Structure):
    """JOBOBJECT_EXTENDED_LIMIT_INFORMATION, with the counters of input and output as one field."""

    _fields_ = (
        ("basic", _BasicLimits),
        ("io_counters", ctypes.c_uint64 * 6),
        ("process_memory", ctypes.c_size_t),
        ("job_memory", ctypes.c_size_t),
        ("peak_process_memory", ctypes.c_size_t),
        ("peak_job_memory", ctypes.c_size_t),
    )


def end_with_this_process(child: subprocess.Popen[bytes]) -> None:
    """Let Windows end ``child`` when this process ends; nothing on other systems.

    Where Windows refuses, as in a job that allows no other, the child keeps its time limit.
    """
    if sys.platform == "win32":
        _kernel32().AssignProcessToJobObject(_job(), int(child._handle))  # type: ignore[attr-defined]  # noqa: SLF001


if sys.platform == "win32":

    @cache
    def _kernel32() -> ctypes.WinDLL:
        library = ctypes.WinDLL("kernel32", use_last_error=True)
        handle = ctypes.c_void_p
        library.CreateJobObjectW.restype = handle
        library.CreateJobObjectW.argtypes = (handle, ctypes.c_wchar_p)
        library.SetInformationJobObject.argtypes = (
            *(handle, ctypes.c_int, handle, ctypes.c_uint32),
        )
        library.AssignProcessToJobObject.argtypes = (handle, handle)
        return library

    @cache
    def _job() -> int:
        """A handle that is never closed: the system does that with the process."""
        library = _kernel32()
        job: int = library.CreateJobObjectW(None, None)
        limits = _ExtendedLimits()
        limits.basic.limit_flags = KILL_ON_JOB_CLOSE
        library.SetInformationJobObject(
            *(job, EXTENDED_LIMIT_INFORMATION, ctypes.byref(limits), ctypes.sizeof(limits))
        )
        return job
