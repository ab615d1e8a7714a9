"""A process that touches a small cube with the device at a port: to be stopped, or killed.

It is asked on a pipe: ``report`` for state and fault counters, ``samples`` for all ticks since the
last time. It ends with the pipe.
"""

from __future__ import annotations

import signal
import sys
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from ....core.servo.session import STATES, HaplyDevice, LinkDevice, Servo
from ....core.servo.settings import Settings
from ..target import YOUNG_MODULUS, cube

RAMP_SECONDS = 0.1
TOP = (0.026, 0.024, 0.05)
UPRIGHT = ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))
"""A 2DIY that stands: its y is the body's z."""


def samples(servo: Servo) -> list[dict[str, Any]]:
    """The recorded ticks: tick, time (s), state, and strength of contact and output (N)."""
    return [
        {
            "tick": int(sample["tick"]),
            "time": float(sample["time"]),
            "state": STATES[sample["state"]],
            "wanted": float(np.linalg.norm(sample["force"])),
            "output": float(np.linalg.norm(sample["output"])),
        }
        for sample in servo.samples()
    ]


def report(servo: Servo) -> dict[str, Any]:
    """Where the servo stands."""
    shot, counters = servo.snapshot(), servo.counters()
    return {
        "state": shot.state,
        "fault": shot.fault,
        "reason": shot.reason,
        "limited": shot.limited,
        "output": float(np.linalg.norm(shot.output_force)),
        "faults": counters["faults"],
        "missed": counters["missed"],
        "longest_gap": counters["longest_gap_us"] * 1e-6,
    }


def touch(line: Connection, port: str, kind: str) -> None:
    """Touch with the device at `port`, a haply or one that speaks the link, until nobody asks."""
    if sys.platform != "win32":
        # Shells let what runs in the background ignore it; here it is to end the process.
        signal.signal(signal.SIGQUIT, signal.SIG_DFL)
    with Servo(cube(), Settings(YOUNG_MODULUS), ramp_seconds=RAMP_SECONDS) as servo:
        if kind == "haply":
            servo.start(HaplyDevice(port, rotation=UPRIGHT, translation=TOP))
        else:
            servo.start(LinkDevice(port))
        while True:
            try:
                asked = line.recv()
            except EOFError:
                return
            line.send(samples(servo) if asked == "samples" else report(servo))
