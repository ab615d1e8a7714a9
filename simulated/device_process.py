"""Process of the simulated device, which speaks the link on a pseudo-terminal or a socket.

Started as `palpate devices simulate`, or by `SimulatedDevice`.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import sys
import time

from ..core.errors import PalpateError
from ..core.machine.stop_signals import stopped_by_signals
from ..core.servo.haply_models import DEFAULT_MODEL, HAPLY_MODELS
from .board.haply_board import HaplyBoard
from .board.simulated_board import SimulatedBoard
from .hand.options import SimulatedOptions, add_simulated_options, simulated_options
from .hand.quaternion import unit
from .lines import Lines
from .real_time import ask_for_real_time

LATE_SECONDS = 200e-6
MOST_STEPS_AT_ONCE = 50
"""Steps at most after a gap in time; for the rest the device stands still."""

Board = SimulatedBoard | HaplyBoard


class Clock:
    """Clock of ticks at absolute deadlines, with statistics."""

    def __init__(self, rate_hz: int) -> None:
        self._period = 1.0 / rate_hz
        self._start = time.perf_counter()
        self._deadline = self._start
        self.ticks = 0
        self.late = 0
        self.skipped = 0
        self.longest_lateness = 0.0

    def now(self) -> float:
        """Seconds since the clock was made."""
        return time.perf_counter() - self._start

    def wait(self) -> int:
        """Sleep until the next deadline; returns the number of periods passed, at least 1."""
        self._deadline += self._period
        while (pause := self._deadline - time.perf_counter()) > 0.0:
            time.sleep(pause)
        lateness = time.perf_counter() - self._deadline
        missed = int(lateness / self._period)
        self._deadline += missed * self._period
        self.ticks += 1
        self.late += lateness > LATE_SECONDS
        self.longest_lateness = max(self.longest_lateness, lateness)
        self.skipped += max(0, missed + 1 - MOST_STEPS_AT_ONCE)
        return min(missed + 1, MOST_STEPS_AT_ONCE)

    def report(self) -> dict[str, object]:
        """Rate reached, and lost ticks."""
        seconds = self.now()
        return {
            "seconds": seconds,
            "rate_hz": self.ticks / seconds,
            "late_ticks": self.late,
            "longest_lateness_us": self.longest_lateness * 1e6,
            "skipped_steps": self.skipped,
        }


def run(
    options: SimulatedOptions,
    *,
    haply: str | None = None,
    commands: bool = False,
    json_lines: bool = True,
) -> None:
    """Run the device until SIGTERM, SIGINT or, with `commands`, the end of standard input.

    `haply` is the model of a Haply 2DIY to simulate; without it the device speaks the link.

    Prints the port at the start and the counters at the end, a JSON line each.
    `commands` reads lines from standard input: `unplug`, `plug`, `buttons MASK`,
    `move X Y Z SECONDS`, `turn W X Y Z SECONDS`, `report` (prints a JSON line).
    Raises PalpateError when there can be no such port.
    """
    board = SimulatedBoard(options) if haply is None else HaplyBoard(options, haply)
    try:
        with stopped_by_signals() as stopped:
            _say_where(board, options, json_lines)
            realtime = ask_for_real_time()
            clock = Clock(options.rate_hz)
            inbox = _Commands() if commands else None
            while not stopped:
                steps = clock.wait()
                board.tick(clock.now(), steps)
                if inbox and not inbox.obey(board, clock):
                    break
            # The reader of the report may be gone.
            with contextlib.suppress(BrokenPipeError):
                report = {"end": True, "realtime": realtime, **clock.report(), **board.report()}
                _print_json(report, json_lines)
    finally:
        board.port.unplug()


class _Commands:
    """Commands from standard input."""

    def __init__(self) -> None:
        self._come = Lines(0)
        self._parent = _parent()

    def obey(self, board: Board, clock: Clock) -> bool:
        """Execute pending commands; False when standard input or the parent has ended."""
        while (line := self._come.next()) is not None:
            self._do(line.decode().split(), board, clock)
        return not self._come.ended and _parent() == self._parent

    @staticmethod
    def _do(words: list[str], board: Board, clock: Clock) -> None:
        match words:
            case ["unplug"]:
                board.unplug()
            case ["plug"]:
                board.plug_in()
            case ["buttons", mask]:
                board.press_buttons(int(mask))
            case ["move", x, y, z, seconds]:
                board.move_hand(clock.now(), (float(x), float(y), float(z)), float(seconds))
            case ["turn", w, x, y, z, seconds]:
                rotation = (float(w), float(x), float(y), float(z))
                board.turn_hand(clock.now(), unit(rotation), float(seconds))
            case ["report"]:
                _print_json({**clock.report(), **board.report()}, True)
            case _:
                raise PalpateError(f"simulated device: no such command: {' '.join(words)}")


def _parent() -> int | None:
    """Number of the process that adopts this one when its parent dies; on Windows none does.

    To ask there is to look through all processes, at each tick (Python 3.11): milliseconds.
    """
    return os.getppid() if os.name == "posix" else None


def _say_where(board: Board, options: SimulatedOptions, json_lines: bool) -> None:
    if json_lines:
        path = board.port.path
        _print_json({"port": path, "link": options.link or None, "pid": os.getpid()}, True)
    else:
        _print(f"simulated device on {board.port.path} (stop with Ctrl-C)")


def _print_json(content: dict[str, object], json_lines: bool) -> None:
    if json_lines:
        _print(json.dumps(content))
        return
    width = max(map(len, content))
    for name, value in content.items():
        _print(f"{name:{width}}  {value}")


def _print(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def add_haply_option(parser: argparse.ArgumentParser) -> None:
    """Add the option for a Haply 2DIY to `parser`."""
    parser.add_argument(
        "--haply",
        nargs="?",
        const=DEFAULT_MODEL,
        metavar="MODEL",
        help="be a Haply 2DIY on a hAPI board instead of a device that speaks the link: "
        f"{', '.join(HAPLY_MODELS)} (default: {DEFAULT_MODEL})",
    )


def main() -> int:
    """Command line of this file."""
    parser = argparse.ArgumentParser(description="A simulated haptic device.")
    add_simulated_options(parser)
    add_haply_option(parser)
    parser.add_argument(
        "--commands",
        action="store_true",
        help="read commands from standard input, and stop when it ends",
    )
    arguments = parser.parse_args()
    try:
        run(simulated_options(arguments), haply=arguments.haply, commands=arguments.commands)
    except PalpateError as error:
        sys.stderr.write(f"palpate: {error}\n")
        return 2
    return 0
