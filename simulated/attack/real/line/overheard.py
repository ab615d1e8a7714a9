"""A line between a host and a device on which somebody listens to what the host says."""

from __future__ import annotations

import contextlib
import os
import select
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Self

from ....real_time import ask_for_real_time

if sys.platform != "win32":
    import fcntl
    import termios
    import tty

LOOK_SECONDS = 0.05
AT_ONCE = 4096
SLOWLY = 8
BITS = 10
"""Of a byte, with a start and a stop bit."""


class Overheard:
    """Passes bytes on between the device at `port` and a host at `Overheard.port`.

    With a speed (bits a second) only as many as a line of that speed carries; what it has not taken
    yet waits where it was written.
    """

    def __init__(self, port: str, baud: int | None = None) -> None:
        self._baud = baud
        self._device = os.open(port, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self._device)
        self._host, self._kept = os.openpty()
        # Kept open: a port that hangs up would tell the device that the host has gone.
        tty.setraw(self._kept)
        os.set_blocking(self._host, False)
        self.port = os.ttyname(self._kept)
        self.said: list[tuple[float, bytes]] = []
        """What the host said, with the time (s, monotonic) at which it was heard."""
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._pass_on)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()
        for descriptor in (self._device, self._host, self._kept):
            os.close(descriptor)

    @contextmanager
    def taken(self) -> Iterator[None]:
        """The port is another program's, which lets nobody else open it."""
        fcntl.ioctl(self._kept, termios.TIOCEXCL)
        try:
            yield
        finally:
            fcntl.ioctl(self._kept, termios.TIOCNXCL)

    def _pass_on(self) -> None:
        # Whoever measures shall not be late itself.
        ask_for_real_time()
        while not self._over.is_set():
            since = time.monotonic()
            ready, _, _ = select.select([self._host, self._device], [], [], LOOK_SECONDS)
            if self._host in ready:
                heard = os.read(self._host, self._most)
                self.said.append((time.monotonic(), heard))
                os.write(self._device, heard)
            if self._device in ready:
                said = os.read(self._device, self._most)
                # Nobody reads between two hosts: what has no room is lost.
                with contextlib.suppress(BlockingIOError):
                    os.write(self._host, said)
            if self._baud is not None:
                time.sleep(max(0.0, since + self._most * BITS / self._baud - time.monotonic()))

    @property
    def _most(self) -> int:
        """Bytes that are passed on at once."""
        return AT_ONCE if self._baud is None else SLOWLY
