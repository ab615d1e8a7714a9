"""A reader that stalls: the thread goes on."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from ....core.servo.session import Pointer, Servo
from ....core.servo.settings import Settings
from ..table import Row
from ..target import ABOVE, YOUNG_MODULUS, cube
from .host import eventually

PERIOD = 1e-3
RING_TICKS = 100
STOPPED_SECONDS = 1.0
STALLED = f"no reader for {STOPPED_SECONDS:g} s, ring full"


def stalled_reader_row(seconds: float = STOPPED_SECONDS) -> Row:
    """Nobody takes snapshots or samples, and the ring is full; then the reader is there again."""
    with Servo(cube(), Settings(YOUNG_MODULUS), record_seconds=0.1) as servo:
        servo.start(Pointer(ABOVE))
        eventually(lambda: servo.snapshot().tick > 0, "the servo runs")
        first = servo.counters()
        time.sleep(seconds)
        last, shot = servo.counters(), servo.snapshot()
        newest_is_seen = shot.tick >= last["ticks"] - 1
    # Once the thread stands: while it runs, a tick has begun that has not been counted as lost.
    end = servo.counters()
    gone = last["ticks"] + last["missed"] - first["ticks"] - first["missed"]
    broken = []
    if gone < 0.9 * seconds / PERIOD:
        broken.append("ticks were held up")
    if not newest_is_seen:
        broken.append("an old snapshot")
    if end["samples_lost"] != end["ticks"] - RING_TICKS:
        broken.append("samples not counted")
    return Row(
        injected=STALLED,
        times=1,
        told=shot.state,
        note=f"{gone} periods, longest tick {last['busy_us']['max']:.0f} us",
        broken=tuple(broken),
    )


def stalled_reader_rows(wanted: Callable[[str], bool]) -> Iterator[Row]:
    """That row, if it is wanted."""
    if wanted(STALLED):
        yield stalled_reader_row()
