"""How well the servo keeps its deadlines, beside a bare native thread in the same run.

    python benchmarks/servo/servo_timing.py [--seconds S] [--rate HZ] [--load ROW]

Both threads run at once, half a period apart, so that whatever else the machine does hits both and
neither waits for the other. The bare thread only sleeps and wakes as early as the servo does, at
the same priority. With ``--link`` a device on a real pseudo-terminal speaks the link, and tells how
long its STATE waits for the FORCE that answers it; beside it times are sent over a bare line. All
claims are ratios to the bare ones (``timing_claims.py``); the exit status is 1 where one does not
hold. To see what an ordinary user gets who has no real-time priority, start it by ``setpriv
--bounding-set=-sys_nice`` on Linux. The servo is led over a body the size of the paper's mouse
while Python is idle, deforms at 60 Hz, keeps the interpreter, or other processes keep every core.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Self

import numpy as np
from palpate_servo import Body, LinkDevice, Pointer, Servo
from palpate_servo.harness import BareTimer

from palpate.benchmarks.measuring.servo.timing_claims import (
    ENOUGH_TICKS,
    LONG_US,
    MOST,
    answer_claim,
    beyond,
    timing_claims,
)
from palpate.core.servo.settings import Settings
from palpate.simulated.attack.real.line.pulse import Pulse
from palpate.tests.bodies.golden_sphere import golden_sphere

RADIUS = 0.025


def ball() -> Body:
    """A ball of 512 triangles on a bed of springs."""
    nodes, triangles = golden_sphere(258, RADIUS)
    return Body(nodes, triangles, np.tile(np.eye(3) * 0.1, (len(nodes), 1, 1)))


def lead(servo: Servo, seconds: float) -> None:
    """A target that circles 3 mm deep; a device leads itself."""
    if servo.counters()["link"]["hellos"]:
        return
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


def beside_busy_processes(servo: Servo, seconds: float) -> None:
    """Lead at 60 Hz while a process for each core counts for nothing."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    with ExitStack() as stack:
        for _ in range(cores or 1):
            busy = stack.enter_context(subprocess.Popen([sys.executable, "-c", "while True: pass"]))
            stack.callback(busy.kill)
        at_60_hz(servo, lambda: None, seconds)


class AnsweredBoard:
    """The board of ``answered_board.py``, until the end of the ``with`` block."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("answered_board.py"))],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.port = self._line()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.communicate()

    def waits(self) -> dict[str, float]:
        """Times from STATE to FORCE, us."""
        if self._process.stdin is None:
            raise RuntimeError("the board was started without pipes")
        self._process.stdin.close()
        self._process.stdin = None
        told: dict[str, float] = json.loads(self._line())
        return told

    def _line(self) -> str:
        if self._process.stdout is None:
            raise RuntimeError("the board was started without pipes")
        return self._process.stdout.readline().strip()


def measure(
    body: Body, rate_hz: int, run: Callable[[Servo], None], *, by_link: bool
) -> tuple[dict[str, Any], dict[str, Any], dict[str, float], float]:
    """Counters of the servo and of the bare thread while `run` goes on; how long STATE waited for
    FORCE, us, of a device on the link; and what p99.9 of the times on a bare line took, us.
    """
    with ExitStack() as stack:
        board = stack.enter_context(AnsweredBoard()) if by_link else None
        servo = stack.enter_context(
            Servo(body, Settings(1000.0), rate_hz=rate_hz, record_seconds=1.0)
        )
        if board is None:
            servo.start(Pointer([0.0, 0.0, 0.03]))
        else:
            servo.start(LinkDevice(board.port))
            while servo.counters()["link"]["device"] is None:
                time.sleep(0.01)
        pulse = stack.enter_context(Pulse()) if by_link else None
        bare = BareTimer(rate_hz, early_waking=True)
        run(servo)
        bare_counters = bare.stop()
        waits = {} if board is None else board.waits()
        line_us = 0.0 if pulse is None else float(np.percentile(pulse.delays(), 99.9)) * 1e6
        servo.stop()
        return dict(servo.counters()), dict(bare_counters), waits, line_us


def line(load: str, thread: str, cells: list[str]) -> str:
    """One line of the table."""
    return f"{load:<20}{thread:<8}" + "".join(f"{cell:>10}" for cell in cells)


def cells_of(counters: dict[str, Any]) -> list[str]:
    """A thread's figures."""
    lateness, ticks = counters["lateness_us"], max(counters["ticks"], 1)
    processor = 100.0 * (counters["busy_us"]["mean"] + counters["spun_us"]["mean"])
    processor *= ticks / (ticks + counters["missed"]) * counters["rate_hz"] * 1e-6
    return [
        f"{counters['longest_gap_us'] * 1e-3:.1f}",
        str(beyond(counters, LONG_US)),
        *(str(counters[key]) for key in ("ticks", "missed", "late_ticks")),
        *(f"{lateness[key]:.1f}" for key in ("p50", "p99", "p99_9", "max")),
        f"{counters['busy_us']['mean']:.1f}",
        f"{processor:.1f}",
    ]


COLUMNS = [
    "gap ms",
    "> 12 ms",
    "ticks",
    "missed",
    "late",
    "p50 us",
    "p99 us",
    "p99.9 us",
    "max us",
    "work us",
    "cpu %",
]


def stages(counters: dict[str, Any]) -> str:
    """Where the servo's ticks spent their time."""
    return "; ".join(
        f"{stage} {times['mean']:.2f} mean, {times['p99']:.2f} p99, {times['max']:.0f} max"
        for stage, times in counters["stages_us"].items()
    )


def main() -> int:
    """Print one table; 1 where a claim does not hold."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=32.0, help="for each row")
    parser.add_argument("--rate", type=int, default=1000, help="Hz")
    parser.add_argument("--load", help="part of a row's name; all rows unless given")
    parser.add_argument("--link", action="store_true", help="a device on a pseudo-terminal")
    arguments = parser.parse_args()
    seconds = arguments.seconds
    body = ball()
    frame = deforming()
    loads: dict[str, Callable[[Servo], None]] = {
        "idle": lambda servo: at_60_hz(servo, lambda: None, seconds),
        "60 Hz deformation": lambda servo: at_60_hz(servo, frame, seconds),
        "Python hogging": lambda servo: hog(servo, seconds),
        "all cores loaded": lambda servo: beside_busy_processes(servo, seconds),
    }
    loads = {name: run for name, run in loads.items() if (arguments.load or "") in name}
    if not loads:
        parser.error(f"no row is called {arguments.load}")
    print(line("load", "thread", COLUMNS))
    measured: dict[str, dict[str, Any]] = {}
    broken = 0
    for name, run in loads.items():
        servo, bare, waits, line_us = measure(body, arguments.rate, run, by_link=arguments.link)
        measured[name] = servo
        claims = {claim.name: claim for claim in timing_claims(servo, bare)}
        print(line(name, "servo", cells_of(servo)))
        print(line("", "bare", cells_of({"rate_hz": arguments.rate, **bare})))
        verdicts = [str(claims[column]) if column in claims else "" for column in COLUMNS]
        print(line("", "ratio", verdicts), flush=True)
        if waits:
            answer = answer_claim(waits, bare, line_us, 1e6 / arguments.rate)
            claims[answer.name] = answer
            told = ", ".join(f"{name} {value:.0f}" for name, value in waits.items())
            print(f"{'':<20}STATE to FORCE, us: {told}; {answer} times", end=" ")
            print(
                f"a period, a bare thread's p99.9 and a bare line's, {answer.bare:.0f}", flush=True
            )
        broken += sum(claim.is_broken for claim in claims.values())
    print("\nstages of the tick, us")
    for name, servo in measured.items():
        print(f"{name:<20}{stages(servo)}")
    print(
        f"\nreal-time priority: {servo['realtime']}; late: over 200 us after the deadline; wanted:"
    )
    print(f"at most {MOST} times the bare ones, of {ENOUGH_TICKS:,} ticks or more.")
    print("cpu: work, and for the servo also the time it is awake before its deadline.")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
