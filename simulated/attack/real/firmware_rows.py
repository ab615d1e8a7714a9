"""The firmware for boards beside a host that ends: what it is told, and its own watchdog."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import partial
from pathlib import Path

from ..table import Row
from ..target import ABOVE
from .desk import Desk, desk
from .firmware_board import FirmwareBoard
from .guardians import ending_rows
from .processes import KILLED, killed_row

NAME = "firmware"


def firmware_rows(program: Path, times: int, wanted: Callable[[str], bool]) -> list[Row]:
    """Rows of hosts that end while they press with `program` (see `FirmwareBoard`)."""

    def place() -> AbstractContextManager[Desk]:
        return desk("link", FirmwareBoard(program, ABOVE))

    injected = f"{KILLED}, {NAME}"
    rows = ending_rows(place, NAME, times, wanted)
    if wanted(injected):
        rows.append(killed_row(times, injected, partial(FirmwareBoard, program, ABOVE)))
    return rows
