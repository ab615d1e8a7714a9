"""A line beside the one that is measured: how long this computer holds up bytes of anybody."""

from __future__ import annotations

import contextlib
import itertools
import os
import struct
import sys
import threading
import time
from typing import Self

from ....real_time import ask_for_real_time

if sys.platform != "win32":
    import tty

EVERY_SECONDS = 0.002
STAMP = struct.Struct("d")


class Pulse:
    """Times on a pseudo-terminal, one every 2 ms, and when they came."""

    def __init__(self) -> None:
        self._reads, self._writes = os.openpty()
        tty.setraw(self._writes)
        os.set_blocking(self._writes, False)
        self._beats: list[tuple[float, float]] = []
        self._over = threading.Event()
        self._threads = [threading.Thread(target=end) for end in (self._beat, self._feel)]
        for thread in self._threads:
            thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        for thread in self._threads:
            thread.join()
        os.close(self._writes)
        os.close(self._reads)

    def longest_ms(self, begin: float, end: float) -> float:
        """The longest that a byte took, or that none was sent, between two times (s), ms."""
        beats = [(sent, came) for sent, came in self._beats if came >= begin and sent <= end]
        sent = [begin, *(one for one, _ in beats), end]
        pauses = (after - before for before, after in itertools.pairwise(sent))
        return 1e3 * max([*pauses, *(came - one for one, came in beats)])

    def delays(self) -> list[float]:
        """How long each took, s."""
        return [came - sent for sent, came in self._beats]

    def forget(self) -> None:
        """Begin anew."""
        self._beats.clear()

    def _beat(self) -> None:
        ask_for_real_time()
        while not self._over.is_set():
            with contextlib.suppress(BlockingIOError):
                os.write(self._writes, STAMP.pack(time.monotonic()))
            time.sleep(EVERY_SECONDS)
        # The reader waits for something.
        os.set_blocking(self._writes, True)
        os.write(self._writes, STAMP.pack(time.monotonic()))

    def _feel(self) -> None:
        ask_for_real_time()
        waiting = b""
        while not self._over.is_set() or not self._beats:
            waiting += os.read(self._reads, 4096)
            came = time.monotonic()
            whole = len(waiting) - len(waiting) % STAMP.size
            for (sent,) in STAMP.iter_unpack(waiting[:whole]):
                self._beats.append((sent, came))
            waiting = waiting[whole:]
