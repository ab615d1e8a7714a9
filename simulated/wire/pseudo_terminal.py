"""Pseudo-terminal as a serial port that can be unplugged."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from ...core.errors import PalpateError
from .device_port import DevicePort

if sys.platform != "win32":
    import fcntl
    import termios
    import tty


class PseudoTerminal(DevicePort):
    """Device's end of a serial port. `link` is a path that always leads to the host's end.

    A host silent for `release_after` seconds is assumed gone.
    """

    def __init__(self, link: Path | None, release_after: float) -> None:
        super().__init__()
        self.link = link
        self._release_after = release_after
        self._heard_at: float | None = None
        """When the host was heard last; None while there is none."""
        self._device_end = -1
        self._host_end = -1
        self.plug_in()

    @property
    def plugged(self) -> bool:
        """Whether the port exists."""
        return self._device_end >= 0

    @property
    def _target(self) -> str:
        return os.ttyname(self._host_end)

    @property
    def path(self) -> str:
        """Path for the host: the link if there is one."""
        return str(self.link) if self.link else self._target

    def plug_in(self) -> None:
        """Create the port."""
        self._device_end, self._host_end = os.openpty()
        # The host's end is kept open here too, or reads without a host would fail.
        tty.setraw(self._host_end)
        os.set_blocking(self._device_end, False)
        self._forget()
        if self.link:
            try:
                _point(self.link, self._target)
            except PalpateError:
                self.unplug()
                raise

    def unplug(self) -> None:
        """Remove the port, also while the host has it open."""
        if not self.plugged:
            return
        if self.link and self.link.is_symlink() and str(self.link.readlink()) == self._target:
            self.link.unlink()
        os.close(self._host_end)
        os.close(self._device_end)
        self._device_end = self._host_end = -1

    def read(self, now: float, /) -> bytes:
        """Bytes from the host; none while unplugged. `now` is in seconds."""
        heard = self._take()
        if heard:
            self._heard_at = now
        elif self._heard_at is not None and now - self._heard_at > self._release_after:
            # Once per silence: later, the next host may be opening the terminal.
            self._heard_at = None
            self._release()
        return heard

    def _take(self) -> bytes:
        if not self.plugged:
            return b""
        try:
            return os.read(self._device_end, 4096)
        except BlockingIOError:
            return b""

    def _send(self, data: bytes) -> int:
        try:
            return os.write(self._device_end, data)
        except BlockingIOError:
            return 0

    def _release(self) -> None:
        """Let the next host open the port, even if the last one locked it and was killed.

        Exclusive mode belongs to the terminal and outlives the process that set it; a real port
        would be closed by then.
        """
        if self.plugged:
            fcntl.ioctl(self._host_end, termios.TIOCNXCL)


def _point(link: Path, target: str) -> None:
    """Make `link` lead to `target` atomically."""
    if link.exists() and not link.is_symlink():
        raise PalpateError("{link}: something else is there already; give another path", link=link)
    try:
        with tempfile.TemporaryDirectory(dir=link.parent) as folder:
            fresh = Path(folder) / link.name
            fresh.symlink_to(target)
            fresh.replace(link)
    except OSError as error:
        raise PalpateError(
            "{link}: the link to the port cannot be made ({reason}); give a path in a folder you "
            "can write to",
            link=link,
            reason=error.strerror,
        ) from error
