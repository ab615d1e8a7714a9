"""`palpate servo --check-timing`: how this computer keeps deadlines, without any device.

Meant to be sent to whoever asks: it says what the computer is, and touches nothing of the user's.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import time
from collections.abc import Sequence
from importlib import metadata
from typing import Any

from ...core.errors import PalpateError
from ...core.servo.session import Pointer, servo_on
from ...core.servo.settings import Settings
from ...simulated.attack.target import ABOVE, EDGE, YOUNG_MODULUS, cube
from .servo_report import for_people

LEAD_EVERY_SECONDS = 1 / 60
RADIUS, DEPTH = 0.1 * EDGE, 0.1 * EDGE
"""Of the circle that is pressed into the cube's top, m."""
TIMES = ("rate_hz", "ticks", "missed", "late_ticks", "lateness_us")
MORE_TIMES = ("longest_gap_us", "busy_us", "spun_us", "realtime", "stages_us")
LATE = ("late_over_10_us", "late_over_50_us", "late_over_200_us", "late_over_1000_us")


def add_check_timing(parser: argparse.ArgumentParser) -> None:
    """Add the option."""
    parser.add_argument(
        "--check-timing",
        action=_CheckTiming,
        nargs=0,
        help="press a cube without any device, print how the deadlines were kept on this computer, "
        "and exit; options such as --seconds and --json stand before it, a body is not needed",
    )


class _CheckTiming(argparse.Action):
    """Option that does all of the command's work, as `--help` does: nothing else need be given."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        _values: str | Sequence[Any] | None,
        _option: str | None = None,
    ) -> None:
        """Check with the options that were given before this one, print, and exit."""
        try:
            report = checked(namespace.seconds, namespace.rate)
        except PalpateError as problem:
            parser.error(str(problem))
        print(json.dumps(report) if namespace.json else for_people(report))
        parser.exit()


def checked(seconds: float, rate_hz: int) -> dict[str, Any]:
    """Press a small cube for some seconds; return what the computer is and how ticks were kept.

    Raises
    ------
    PalpateError
        The time is none.
    """
    if not 0.0 < seconds < math.inf:
        raise PalpateError("--seconds: the time must be more than 0 s and have an end")
    servo = servo_on(cube(), Settings(YOUNG_MODULUS), rate_hz=rate_hz)
    servo.start(Pointer(ABOVE))
    begin = time.monotonic()
    while (now := time.monotonic() - begin) < seconds:
        servo.set_target(_on_circle(4.0 * now))
        time.sleep(LEAD_EVERY_SECONDS)
    servo.stop()
    counters: dict[str, Any] = {**servo.counters()}
    return {
        **computer(),
        "seconds": time.monotonic() - begin,
        **{name: counters[name] for name in (*TIMES, *LATE, *MORE_TIMES)},
    }


def computer() -> dict[str, Any]:
    """Return what the computer and its Python are; no name of it or of its user."""
    return {
        "system": f"{platform.system()} {platform.release()}, {platform.version()}",
        "machine": f"{platform.machine()}, {os.cpu_count()} processors",
        "python": platform.python_version(),
        "palpate_servo": metadata.version("palpate_servo"),
        "clock_resolution_us": time.get_clock_info("perf_counter").resolution * 1e6,
    }


def _on_circle(angle: float) -> tuple[float, float, float]:
    middle = 0.5 * EDGE
    return (
        middle + RADIUS * math.cos(angle),
        middle + RADIUS * math.sin(angle),
        EDGE - DEPTH,
    )
