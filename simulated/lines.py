"""Lines of a stream, read by a thread: Windows lets nobody wait for a pipe with a deadline."""

from __future__ import annotations

import os
import threading
from queue import Empty, SimpleQueue


class Lines:
    """Lines that come from a descriptor, without their ends.

    The thread goes with the stream, or with the process.
    """

    def __init__(self, descriptor: int) -> None:
        self._come: SimpleQueue[bytes | None] = SimpleQueue()
        self._thread = threading.Thread(target=self._read, args=(descriptor,), daemon=True)
        self._thread.start()
        self.ended = False
        """Whether the stream has ended, and its last line was taken."""

    def next(self, seconds: float = 0.0) -> bytes | None:
        """Return the next line, waiting for it that long; None if none has come or none will."""
        if self.ended:
            return None
        try:
            line = self._come.get(timeout=seconds) if seconds > 0.0 else self._come.get_nowait()
        except Empty:
            return None
        self.ended = line is None
        return line

    def wait_for_end(self) -> None:
        """Wait until the stream has ended."""
        self._thread.join()

    def _read(self, descriptor: int) -> None:
        begun = b""
        while piece := self._piece(descriptor):
            *lines, begun = (begun + piece).split(b"\n")
            for line in lines:
                self._come.put(line)
        if begun:
            self._come.put(begun)
        self._come.put(None)

    @staticmethod
    def _piece(descriptor: int) -> bytes:
        try:
            return os.read(descriptor, 4096)
        except OSError:
            # Closed, or broken by its other end.
            return b""
