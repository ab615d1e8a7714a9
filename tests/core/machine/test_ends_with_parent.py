"""A child ends with its parent, also where the parent was killed."""

import ctypes
import subprocess
import sys
import time

import psutil
import pytest

from palpate.core.machine import ends_with_parent

PARENT = """
import subprocess, sys, time
from palpate.core.machine.ends_with_parent import end_with_this_process
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
end_with_this_process(child)
print(child.pid, flush=True)
time.sleep(600)
"""


@pytest.mark.skipif(sys.platform != "win32", reason="Windows: elsewhere nothing is bound")
def test_a_child_ends_with_a_killed_parent():
    with subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE) as parent:
        child = psutil.Process(int(parent.stdout.readline()))
        assert child.is_running()
        parent.kill()
    deadline = time.monotonic() + 60
    while child.is_running() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not child.is_running()


def test_limits_are_laid_out_as_windows_reads_them():
    """Sizes and places of winnt.h on 64 bits."""
    assert ctypes.sizeof(ends_with_parent._ExtendedLimits) == 144
    assert ends_with_parent._BasicLimits.limit_flags.offset == 16
    assert ends_with_parent._ExtendedLimits.process_memory.offset == 112
