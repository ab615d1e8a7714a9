"""A process with a servo, and the simulated device that it is to meet."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Self

from ....core.errors import PalpateError
from ...hand.options import SimulatedOptions
from ...simulated_process import SimulatedDevice
from ..target import ABOVE
from . import servo_host

if TYPE_CHECKING:
    # Windows has none.
    from multiprocessing.context import ForkServerContext

PATIENCE_SECONDS = 20.0


def _nursery() -> ForkServerContext:
    """Where hosts come from: a process that has imported for all of them what they need."""
    nursery = multiprocessing.get_context("forkserver")
    nursery.set_forkserver_preload(["__main__", servo_host.__name__])
    return nursery


class Host:
    """`servo_host.py` as a process of its own."""

    def __init__(self, port: str, kind: str = "link") -> None:
        nursery = _nursery()
        self._line, its_end = nursery.Pipe()
        self.process = nursery.Process(target=servo_host.touch, args=(its_end, port, kind))
        self.process.start()
        its_end.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.join()
        self._line.close()

    def ask(self, line: str) -> Any:
        """The answer to a line. Raises NotReachedError when it has ended."""
        try:
            self._line.send(line)
            return self._line.recv()
        except (EOFError, ConnectionError) as error:
            raise NotReachedError(
                "attack: the host has ended, with what it said above; give this computer less to "
                "do, and try again"
            ) from error

    def report(self) -> dict[str, Any]:
        """Where the servo stands now."""
        answer: dict[str, Any] = self.ask("report")
        return answer

    def samples(self) -> list[dict[str, Any]]:
        """All ticks since the last time."""
        answer: list[dict[str, Any]] = self.ask("samples")
        return answer

    @property
    def pid(self) -> int:
        """Process id."""
        if self.process.pid is None:
            raise RuntimeError("the host was not started")
        return self.process.pid

    def signal(self, number: int) -> None:
        """Send the process a signal."""
        os.kill(self.pid, number)

    def end(self) -> int | None:
        """Have it end by itself; its exit code."""
        self._line.close()
        self.process.join()
        return self.process.exitcode


class NotReachedError(PalpateError):
    """Something that was waited for did not come."""


def eventually(condition: Callable[[], bool], what: str) -> None:
    """Wait for something; NotReachedError when it does not come."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while not condition():
        if time.monotonic() > deadline:
            raise NotReachedError(
                "attack: waited {seconds:g} s in vain until {what}; give this computer less to do, "
                "and try again",
                seconds=PATIENCE_SECONDS,
                what=what,
            )
        time.sleep(0.005)


def device() -> SimulatedDevice:
    """A simulated device with a hand above the cube."""
    return SimulatedDevice(SimulatedOptions(rest=ABOVE, hand_stiffness=800.0))
