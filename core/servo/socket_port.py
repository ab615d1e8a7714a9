"""Socket of this computer as a port: a simulated device's, where pseudo-terminals are missing."""

from __future__ import annotations

import errno
import ipaddress
import select
import socket
from typing import Self

from ..errors import PalpateError

SCHEME = "socket://"
CONNECT_SECONDS = 2.0
HANGS_UP_SECONDS = 0.05
"""A device that has another host hangs up at once; this is many of its periods."""
MOST_SEEN = 4096


def is_socket(path: str) -> bool:
    """Tell whether a port's name is that of a socket."""
    return path.startswith(SCHEME)


def address_of(path: str) -> tuple[str, int]:
    """Return address and number in a name such as `socket://127.0.0.1:4000`.

    Raises
    ------
    PalpateError
        It is no such name, or of another computer.
    """
    address, _, number = path.removeprefix(SCHEME).rpartition(":")
    try:
        if is_socket(path) and ipaddress.IPv4Address(address).is_loopback:
            return address, int(number)
    except ValueError:
        pass
    raise PalpateError(
        "{path}: no socket of this computer; name one as {example}",
        path=path,
        example=f"{SCHEME}127.0.0.1:4000",
    )


class SocketPort:
    """A connection to a device, used as a `serial.Serial` is.

    Raises OSError when nobody listens there, and of number EBUSY when the device has another host.
    """

    def __init__(self, path: str, timeout: float) -> None:
        self.timeout = timeout
        """Longest wait of `read`, s."""
        self._stream = socket.create_connection(address_of(path), timeout=CONNECT_SECONDS)
        if self._waits_for(HANGS_UP_SECONDS) and not self._seen():
            self.close()
            raise OSError(errno.EBUSY, "the device has another host")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def in_waiting(self) -> int:
        """Bytes that have come, as far as they are counted."""
        return self._seen() if self._waits_for(0.0) else 0

    def read(self, size: int) -> bytes:
        """Return what has come, at most `size` bytes; none after `timeout`."""
        if not self._waits_for(self.timeout):
            return b""
        data = self._stream.recv(size)
        if not data:
            raise ConnectionResetError(errno.ECONNRESET, "the device has hung up")
        return data

    def write(self, data: bytes) -> int:
        """Send all of it."""
        self._stream.settimeout(CONNECT_SECONDS)
        self._stream.sendall(data)
        return len(data)

    def close(self) -> None:
        """Hang up."""
        self._stream.close()

    def _seen(self) -> int:
        return len(self._stream.recv(MOST_SEEN, socket.MSG_PEEK))

    def _waits_for(self, seconds: float) -> bool:
        return bool(select.select([self._stream], [], [], seconds)[0])
