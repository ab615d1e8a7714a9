"""The firmware for boards (`firmware/host/main.cpp`, compiled) beside a host that ends: what it is
told, and its own watchdog.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

from ....core.errors import PalpateError
from ...hand.plant import Vector
from ..table import Row
from ..target import ABOVE
from .desk import Desk, desk
from .guardians import ending_rows
from .processes import KILLED, killed_row

NAME = "firmware"


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

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
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


def firmware_rows(program: Path, times: int, wanted: Callable[[str], bool]) -> list[Row]:
    """Rows of hosts that end while they press with `program` (see `FirmwareBoard`)."""

    def place() -> AbstractContextManager[Desk]:
        return desk("link", FirmwareBoard(program, ABOVE))

    injected = f"{KILLED}, {NAME}"
    rows = ending_rows(place, NAME, times, wanted)
    if wanted(injected):
        rows.append(killed_row(times, injected, partial(FirmwareBoard, program, ABOVE)))
    return rows


def _pipe(stream: IO[str] | None) -> IO[str]:
    if stream is None:
        raise RuntimeError("the program was started without this pipe")
    return stream
