"""A process that touches a small cube with the device at a port: to be stopped, or killed.

    python tests/fault_injection/servo_host.py PORT

Reads lines: ``report`` prints state and fault counters, ``samples`` all ticks since the last time,
a line of JSON each. It ends with its standard input.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import numpy as np
from palpate_servo import STATES, Body, LinkDevice, Servo

from palpate.core.servo.settings import Settings

EDGE = 0.05
YOUNG_MODULUS = 10_000.0
RAMP_SECONDS = 0.1
ABOVE = (0.026, 0.024, 0.06)
DEEP = (0.026, 0.024, 0.042)
SQUARES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def cube(edge: float = EDGE) -> Body:
    """Eight corners of 100 N/m at 10 kPa each."""
    nodes = [[x, y, z] for x in (0.0, edge) for y in (0.0, edge) for z in (0.0, edge)]
    triangles = [half for a, b, c, d in SQUARES for half in ((a, b, c), (a, c, d))]
    return Body(np.array(nodes), np.array(triangles), np.tile(np.eye(3) * 0.01, (8, 1, 1)))


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


def main() -> int:
    """Touch until standard input ends."""
    with Servo(cube(), Settings(YOUNG_MODULUS), ramp_seconds=RAMP_SECONDS) as servo:
        servo.start(LinkDevice(sys.argv[1]))
        for line in sys.stdin:
            answer = samples(servo) if line.strip() == "samples" else report(servo)
            print(json.dumps(answer), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
