"""TCP socket of this computer as a serial port, where there are no pseudo-terminals."""

from __future__ import annotations

import socket

from ...core.errors import PalpateError
from ...core.servo.socket_port import SCHEME, address_of
from .device_port import DevicePort

BUFFER_BYTES = 4096
"""What the system holds of each direction, about: a host that stops reading is noticed."""
MOST_READS = 64
"""Of a period: a host that never ends is heard again in the next one."""
KNOCKS_EVERY = 16
"""Periods with a host after which it is looked whether another one has come."""


class LocalSocket(DevicePort):
    """Device's end of a connection to `path`, such as `socket://127.0.0.1:4000`; 0: any free port.

    It has one host at a time: whoever else connects is hung up on.

    Raises PalpateError when nobody can listen there.
    """

    def __init__(self, path: str) -> None:
        super().__init__()
        self._address = address_of(path)
        self._listening: socket.socket | None = None
        self._host: socket.socket | None = None
        self._alone = 0
        self.plug_in()

    @property
    def plugged(self) -> bool:
        """Whether the port exists."""
        return self._listening is not None

    @property
    def path(self) -> str:
        """Name of the port for the host."""
        address, number = self._address
        return f"{SCHEME}{address}:{number}"

    def plug_in(self) -> None:
        """Listen, at the same address as before."""
        try:
            listening = socket.create_server(self._address)
        except OSError as error:
            raise PalpateError(
                "{path}: nobody can listen there ({reason}); choose port 0 for any free one",
                path=self.path,
                reason=error.strerror,
            ) from error
        for queue in (socket.SO_RCVBUF, socket.SO_SNDBUF):
            listening.setsockopt(socket.SOL_SOCKET, queue, BUFFER_BYTES)
        listening.setblocking(False)
        self._listening = listening
        self._address = listening.getsockname()
        self._forget()

    def unplug(self) -> None:
        """Stop listening, and hang up."""
        self._hang_up()
        if self._listening:
            self._listening.close()
        self._listening = None

    def read(self, _now: float, /) -> bytes:
        """Bytes from the host; none while unplugged."""
        # To ask the system is most of what a period takes.
        self._alone = (self._alone + 1) % KNOCKS_EVERY if self._host else 0
        # Who has come first: one that comes as the last host goes finds that one gone.
        coming = [] if self._alone else self._coming()
        heard = self._take()
        for host in coming:
            if self._host is None:
                self._greet(host)
                # It may have spoken already.
                heard += self._take()
            else:
                host.close()
        return heard

    def _take(self) -> bytes:
        """All that has come: a host that is gone is noticed behind the last that it said."""
        heard = bytearray()
        for _ in range(MOST_READS):
            if self._host is None:
                break
            try:
                part = self._host.recv(BUFFER_BYTES)
            except BlockingIOError:
                break
            except ConnectionError:
                part = b""
            if not part:
                self._hang_up()
            heard += part
            if len(part) < BUFFER_BYTES:
                break
        return bytes(heard)

    def _coming(self) -> list[socket.socket]:
        """Connections that nobody has answered yet."""
        found: list[socket.socket] = []
        while self._listening:
            try:
                found.append(self._listening.accept()[0])
            except (BlockingIOError, ConnectionError):
                break
        return found

    def _greet(self, host: socket.socket) -> None:
        self._forget()
        host.setblocking(False)
        host.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._host = host

    def _send(self, data: bytes) -> int:
        if self._host is None:
            return 0
        try:
            return self._host.send(data)
        except (BlockingIOError, ConnectionError):
            # That it is gone is found by reading: it may have said something before.
            return 0

    def _hang_up(self) -> None:
        if self._host:
            self._host.close()
        self._host = None
        self._forget()
