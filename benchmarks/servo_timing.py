"""How well the servo keeps its deadlines, beside a bare native thread in the same run.

    python benchmarks/servo_timing.py [--seconds S] [--rate HZ]

Both threads run at once, so that whatever else the machine does hits both. The servo is led over a
body the size of the paper's mouse while Python is idle, deforms at 60 Hz, or keeps the interpreter.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from palpate_servo import BareTimer, Body, Servo

RADIUS = 0.025


def ball(halvings: int = 3) -> Body:
    """An octahedron halved into 8 * 4^halvings triangles, blown up to a ball."""
    corners = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    nodes = [np.array(corner, float) for corner in corners]
    triangles = [
        [0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5],
    ]  # fmt: skip
    for _ in range(halvings):
        middles: dict[tuple[int, int], int] = {}
        finer = []
        for triangle in triangles:
            between = []
            for i, j in zip(triangle, triangle[1:] + triangle[:1], strict=True):
                pair = (min(i, j), max(i, j))
                if pair not in middles:
                    middles[pair] = len(nodes)
                    nodes.append(nodes[i] + nodes[j])
                between.append(middles[pair])
            (a, b, c), (ab, bc, ca) = triangle, between
            finer += [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        triangles = finer
        nodes = [node / np.linalg.norm(node) for node in nodes]
    return Body(np.array(nodes) * RADIUS, triangles, np.tile(np.eye(3) * 0.1, (len(nodes), 1, 1)))


def lead(servo: Servo, seconds: float) -> None:
    """A target that circles 3 mm deep."""
    angle = 4.0 * seconds
    direction = np.array([0.5 * np.cos(angle), 0.5 * np.sin(angle), 1.0])
    servo.set_target(direction / np.linalg.norm(direction) * (RADIUS - 0.003))


def at_60_hz(servo: Servo, work: Callable[[], object], seconds: float) -> None:
    """Lead and work at 60 Hz, as a user interface does."""
    start = time.perf_counter()
    while (now := time.perf_counter() - start) < seconds:
        lead(servo, now)
        work()
        time.sleep(max(0.0, 1 / 60 - (time.perf_counter() - start - now)))


def deforming() -> Callable[[], object]:
    """Nine columns of the mouse's compliance, and the map to 20,000 drawn vertices."""
    rng = np.random.default_rng(1)
    columns = rng.normal(size=(1036 * 3, 1036 * 3)).astype(np.float32)
    nearest = rng.integers(0, 1036, (20_000, 3))

    def frame() -> object:
        touched = 3 * int(rng.integers(0, 1000))
        moved = columns[:, touched : touched + 9] @ np.ones(9, np.float32)
        return moved.reshape(-1, 3)[nearest].mean(axis=1)

    return frame


def hog(servo: Servo, seconds: float) -> None:
    """Products of large integers, with no turn for anybody who waits for the interpreter."""
    number = 3**200_000
    interval = sys.getswitchinterval()
    sys.setswitchinterval(10.0)
    try:
        start = time.perf_counter()
        while (now := time.perf_counter() - start) < seconds:
            lead(servo, now)
            _ = number * number
    finally:
        sys.setswitchinterval(interval)


def measure(
    body: Body, rate_hz: int, run: Callable[[Servo], None]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Counters of the servo and of the bare thread while `run` goes on."""
    with Servo(body, young_modulus=1000.0, rate_hz=rate_hz, record_seconds=1.0) as servo:
        servo.start_pointer([0.0, 0.0, 0.03])
        bare = BareTimer(rate_hz)
        run(servo)
        bare_counters = bare.stop()
        servo.stop()
        return dict(servo.counters()), dict(bare_counters)


def ratio(one: float, other: float) -> str:
    """How many times as much, where that says anything."""
    return f"{one / other:6.2f}" if other else "     -"


def main() -> None:
    """Print one table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=5.0, help="for each row")
    parser.add_argument("--rate", type=int, default=1000, help="Hz")
    arguments = parser.parse_args()
    seconds = arguments.seconds
    body = ball()
    frame = deforming()
    loads: dict[str, Callable[[Servo], None]] = {
        "idle": lambda servo: at_60_hz(servo, lambda: None, seconds),
        "60 Hz deformation": lambda servo: at_60_hz(servo, frame, seconds),
        "Python hogging": lambda servo: hog(servo, seconds),
    }
    columns = ("ticks", "missed", "late", "p50 us", "p99 us", "p99.9 us", "max us", "work us")
    print(f"{'load':<20}{'thread':<8}" + "".join(f"{name:>10}" for name in columns))
    realtime = ""
    for name, run in loads.items():
        servo, bare = measure(body, arguments.rate, run)
        for thread, counters in (("servo", servo), ("bare", bare)):
            lateness = counters["lateness_us"]
            times = [lateness[key] for key in ("p50", "p99", "p99_9", "max")]
            counts = [counters[key] for key in ("ticks", "missed", "late_ticks")]
            print(
                f"{name if thread == 'servo' else '':<20}{thread:<8}"
                + "".join(f"{count:>10}" for count in counts)
                + "".join(f"{us:>10.1f}" for us in [*times, counters["busy_us"]["mean"]])
            )
        realtime = servo["realtime"]
        late = ratio(servo["late_ticks"], bare["late_ticks"])
        tail = ratio(servo["lateness_us"]["p99_9"], bare["lateness_us"]["p99_9"])
        print(f"{'':<20}{'ratio':<8}{'':>20}    {late}{'':>20}    {tail}")
    print(f"real-time priority: {realtime}; late: more than 200 us after the deadline")


if __name__ == "__main__":
    main()
