"""A process with a servo, and the simulated device that it is to meet."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any, Self

from ....core.errors import PalpateError
from ....core.machine import run_module
from ...hand.options import SimulatedOptions
from ...simulated_process import SimulatedDevice
from ..target import ABOVE

PATIENCE_SECONDS = 20.0


class Host:
    """`servo_host.py` as a process of its own, in a session of its own."""

    def __init__(self, port: str, kind: str = "link") -> None:
        self.process = subprocess.Popen(  # noqa: S603 - our own module, no shell
            [sys.executable, *run_module.command("simulated.attack.real.servo_host"), port, kind],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.process.kill()
        self.process.communicate()

    def ask(self, line: str) -> Any:
        """The answer to a line."""
        if self.process.stdin is None or self.process.stdout is None:
            raise RuntimeError("the host was started without pipes")
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def report(self) -> dict[str, Any]:
        """Where the servo stands now."""
        answer: dict[str, Any] = self.ask("report")
        return answer

    def samples(self) -> list[dict[str, Any]]:
        """All ticks since the last time."""
        answer: list[dict[str, Any]] = self.ask("samples")
        return answer

    def signal(self, number: int) -> None:
        """Send the process a signal."""
        os.kill(self.process.pid, number)


def eventually(condition: Callable[[], bool], what: str) -> None:
    """Wait for something; PalpateError when it does not come."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while not condition():
        if time.monotonic() > deadline:
            raise PalpateError(
                "attack: waited {seconds:g} s in vain until {what}; give this computer less to do, "
                "and try again",
                seconds=PATIENCE_SECONDS,
                what=what,
            )
        time.sleep(0.005)


def device() -> SimulatedDevice:
    """A simulated device with a hand above the cube."""
    return SimulatedDevice(SimulatedOptions(rest=ABOVE, hand_stiffness=800.0))
