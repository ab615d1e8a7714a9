"""A line between a host and a device on which somebody listens to what the host says."""

from __future__ import annotations

import contextlib
import os
import select
import sys
import threading
import time
from types import TracebackType
from typing import Self

from ...real_time import ask_for_real_time

if sys.platform != "win32":
    import tty

LOOK_SECONDS = 0.05


class Overheard:
    """Passes bytes on between the device at `port` and a host at `Overheard.port`."""

    def __init__(self, port: str) -> None:
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

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._over.set()
        self._thread.join()
        for descriptor in (self._device, self._host, self._kept):
            os.close(descriptor)

    def _pass_on(self) -> None:
        # Whoever measures shall not be late itself.
        ask_for_real_time()
        while not self._over.is_set():
            ready, _, _ = select.select([self._host, self._device], [], [], LOOK_SECONDS)
            if self._host in ready:
                heard = os.read(self._host, 4096)
                self.said.append((time.monotonic(), heard))
                os.write(self._device, heard)
            if self._device in ready:
                said = os.read(self._device, 4096)
                # Nobody reads between two hosts: what has no room is lost.
                with contextlib.suppress(BlockingIOError):
                    os.write(self._host, said)
