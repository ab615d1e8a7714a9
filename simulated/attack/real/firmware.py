"""The firmware for boards (`firmware/host/main.cpp`, compiled) beside a host that ends: what it is
told, and its own watchdog.
"""

from __future__ import annotations

import json
import subprocess
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import IO, Any, Self

from ....core.errors import PalpateError
from ...hand.plant import Vector
from ..table import Row
from ..target import ABOVE
from .desk import WAYS, Desk, desk
from .guardians import ending_rows
from .host import Host, eventually
from .lost_guardians import leave_alone
from .pressing import Hand
from .processes import KILLED, SUSPENDED, killed_row, suspended_row
from .trials import trials

NAME = "firmware"
SLOW_BAUDS = (9_600, 19_200)
"""Too slow for any force in protocol 2, however few STATE a board that is held up sends."""
BEHIND_SECONDS = 0.5


class FirmwareBoard:
    """That program; it answers as `SimulatedDevice` does, as far as attacks ask.

    Its tip goes where it is told, whatever the force. Raises PalpateError where it does not run.
    """

    def __init__(self, program: Path, above: Vector) -> None:
        try:
            self._process = subprocess.Popen(  # noqa: S603 - what the user names, no shell
                [str(program.absolute())],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
        except OSError as error:
            raise PalpateError(
                "{program}: it cannot be started ({reason}); compile firmware/host/main.cpp as "
                "firmware/README.md tells, and give its path",
                program=program,
                reason=error.strerror,
            ) from error
        self.port = self._answer()
        self.move_hand(above, 0.0)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.communicate()

    def move_hand(self, position: Vector, seconds: float) -> None:
        """Bring the tip to `position` (m) in `seconds`."""
        x, y, z = (f"{1e6 * part:.9g}" for part in position)
        self._tell(f"move {x} {y} {z} {1e3 * seconds:.9g}")

    def report(self) -> dict[str, Any]:
        """What attacks ask for, SI units."""
        self._tell("report")
        said = json.loads(self._answer())
        return {
            "limp": said["mode"] == "limp",
            "limp_after": said["limp_after_us"] * 1e-6,
            "limp_look": said["limp_look_us"] * 1e-6,
            "felt_force": said["force"],
            "largest_force": said["strongest"],
        }

    def _tell(self, line: str) -> None:
        pipe = _pipe(self._process.stdin)
        pipe.write(line + "\n")
        pipe.flush()

    def _answer(self) -> str:
        line = _pipe(self._process.stdout).readline().strip()
        if not line:
            raise PalpateError("the board's program has ended; run it by hand to see what it says")
        return line


def firmware_rows(program: Path, times: int, wanted: Callable[[str], bool]) -> Iterator[Row]:
    """Rows of hosts that end while they press with `program` (see `FirmwareBoard`)."""

    def place() -> AbstractContextManager[Desk]:
        return desk("link", FirmwareBoard(program, ABOVE))

    board = partial(FirmwareBoard, program, ABOVE)
    others: dict[str, Callable[[str], Row]] = {
        f"{KILLED}, {NAME}": lambda name: killed_row(times, name, board),
        f"SIGKILL to the host and its guardian, {NAME}": lambda name: killed_row(
            times, name, board, leave_alone
        ),
        f"{SUSPENDED}, {NAME}": lambda name: suspended_row(times, name, board),
    }
    for baud in SLOW_BAUDS:
        others[f"behind {baud} baud, {NAME}"] = partial(slow_row, board, baud, times)
    yield from ending_rows(place, NAME, times, wanted)
    yield from (row(injected) for injected, row in others.items() if wanted(injected))


def slow_row(
    board: Callable[[], AbstractContextManager[Hand]], baud: int, times: int, injected: str
) -> Row:
    """A line that is too slow: the host says so, and whatever the hand does there is no force."""
    with board() as hand, desk("link", nullcontext(hand), baud) as at:
        tried = trials(times, partial(press_behind, at))
        strongest = float(hand.report()["largest_force"])
    told = Counter(one.told for one in tried.judged).most_common(1)
    return Row(
        injected=injected,
        times=len(tried.judged),
        told=told[0][0] if told else "",
        felt=strongest,
        note=tried.note,
        broken=("force behind a line that is too slow",) if strongest > 0.0 else tried.unjudged,
    )


@dataclass(frozen=True)
class Behind:
    """A host behind a slow line, and by which name it told that."""

    told: str
    held_up_ms: float = 0.0
    """A line that is held up is slower still."""


def press_behind(at: Desk) -> Behind:
    """Bring the hand into the body of a host that has told that words come too late."""
    with at.host() as host:
        told = told_late(host)
        way = WAYS[at.kind]
        at.hand.move_hand(way.deep, way.seconds)
        time.sleep(BEHIND_SECONDS)
    return Behind(told)


def told_late(host: Host) -> str:
    """Wait until a host says that words come too late; by which name."""

    def late() -> str:
        faults = host.report()["faults"]
        return next((name for name in ("deaf", "stale") if faults[name]), "")

    eventually(lambda: bool(late()), "the host says that the line is too slow")
    return late()


def _pipe(stream: IO[str] | None) -> IO[str]:
    if stream is None:
        raise RuntimeError("the program was started without this pipe")
    return stream
