"""The device's end of a port that can be unplugged."""

from __future__ import annotations

from abc import ABC, abstractmethod

BACKLOG_BYTES = 256
"""Unread bytes beyond which frames are dropped, as by a board's small buffer."""


class DevicePort(ABC):
    """A port for one host at a time; the host opens `path`."""

    def __init__(self) -> None:
        self.dropped = 0
        """Frames that found no room because nobody reads."""
        self._backlog = b""

    @property
    @abstractmethod
    def plugged(self) -> bool:
        """Whether the port exists."""

    @property
    @abstractmethod
    def path(self) -> str:
        """Name of the port for the host."""

    @abstractmethod
    def plug_in(self) -> None:
        """Create the port, at the same path as before."""

    @abstractmethod
    def unplug(self) -> None:
        """Remove the port, also while the host has it open."""

    @abstractmethod
    def read(self, now: float, /) -> bytes:
        """Bytes from the host; none while unplugged. `now` is in seconds."""

    @abstractmethod
    def _send(self, data: bytes) -> int:
        """Hand bytes over to the system; how many of them it took."""

    def write(self, data: bytes) -> None:
        """Send frames to the host; dropped if it has stopped reading."""
        if not self.plugged or not data:
            return
        if len(self._backlog) > BACKLOG_BYTES:
            self.dropped += data.count(0)
            data = b""
        self._backlog += data
        self._backlog = self._backlog[self._send(self._backlog) :]

    def _forget(self) -> None:
        """Leave what was not sent to a host that is gone."""
        self._backlog = b""
