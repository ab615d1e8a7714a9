"""A program that forks while it is touched: the other process has the memory, not the thread."""

import os
import subprocess
import sys

import pytest

SCRIPT = """
import os, sys, time
import numpy as np
from palpate_servo import Body, Pointer, Servo
from palpate.core.servo.settings import Settings

nodes = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * 0.1
triangles = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
servo = Servo(Body(nodes, triangles, np.array([0.01 * np.eye(3)] * 4)), Settings(1e4))
servo.start_recording(10.0)
servo.start(Pointer((0.2, 0.2, 0.2)))
child = os.fork()
if child == 0:
    assert not servo.running
    {leave}
    sys.exit(0)
_, status = os.waitpid(child, 0)
ticks = servo.snapshot().tick
deadline = time.monotonic() + 20.0
while servo.snapshot().tick <= ticks and time.monotonic() < deadline:
    time.sleep(0.002)
assert servo.running and servo.is_recording and servo.snapshot().tick > ticks
servo.stop()
sys.exit(status)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.parametrize("leave", ["pass", "servo.stop()", "del servo", "servo.stop_recording()"])
def test_a_forked_process_ends_quietly_and_leaves_the_servo_to_the_other(leave):
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", SCRIPT.format(leave=leave)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
