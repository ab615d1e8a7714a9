"""A serial port without a cable: a pseudo-terminal whose path can vanish and come back."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from ...core.errors import PalpateError

if sys.platform != "win32":
    import fcntl
    import termios
    import tty

RELEASE_AFTER_SECONDS = 0.5
BACKLOG_BYTES = 256
"""Frames that the host does not read are dropped beyond this, as a board's small buffer would."""


def require_pseudo_terminals() -> None:
    """Raises PalpateError on Windows, which has none."""
    if sys.platform == "win32":
        raise PalpateError(
            "the simulated device needs a pseudo-terminal, which Windows does not have; "
            "use Linux, macOS or WSL, or plug in a real device"
        )


class PseudoTerminal:
    """The device's end of a serial port. `link` is a path that always leads to the host's end.

    A host that was silent for `release_after` seconds is taken for gone.
    """

    def __init__(self, link: Path | None, release_after: float = RELEASE_AFTER_SECONDS) -> None:
        require_pseudo_terminals()
        self.link = link
        self._release_after = release_after
        self._heard_at: float | None = None
        """When the host was heard last; None while there is none."""
        self.dropped = 0
        """Frames that found no room because nobody reads."""
        self._device_end = -1
        self._host_end = -1
        self._backlog = b""
        self.plug_in()

    @property
    def plugged(self) -> bool:
        """Whether there is a port at all."""
        return self._device_end >= 0

    @property
    def _target(self) -> str:
        return os.ttyname(self._host_end)

    @property
    def path(self) -> str:
        """Where the host opens the port now: the link when there is one."""
        return str(self.link) if self.link else self._target

    def plug_in(self) -> None:
        """Make the port appear."""
        self._device_end, self._host_end = os.openpty()
        # The host's end is kept open here too, or reading would fail whenever no host is there.
        tty.setraw(self._host_end)
        os.set_blocking(self._device_end, False)
        self._backlog = b""
        if self.link:
            try:
                _point(self.link, self._target)
            except PalpateError:
                self.unplug()
                raise

    def unplug(self) -> None:
        """Make the port vanish under the host's hands."""
        if not self.plugged:
            return
        if self.link and self.link.is_symlink() and str(self.link.readlink()) == self._target:
            self.link.unlink()
        os.close(self._host_end)
        os.close(self._device_end)
        self._device_end = self._host_end = -1

    def read(self, now: float) -> bytes:
        """What the host has written since; nothing while unplugged. `now` is in seconds."""
        heard = self._take()
        if heard:
            self._heard_at = now
        elif self._heard_at is not None and now - self._heard_at > self._release_after:
            # Once a silence: the next host may be taking the terminal at any later moment.
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

    def write(self, data: bytes) -> None:
        """Send frames to the host, or drop them when it has stopped reading."""
        if not self.plugged or not data:
            return
        if len(self._backlog) > BACKLOG_BYTES:
            self.dropped += data.count(0)
            data = b""
        self._backlog += data
        try:
            sent = os.write(self._device_end, self._backlog)
        except BlockingIOError:
            return
        self._backlog = self._backlog[sent:]

    def _release(self) -> None:
        """Let the next host open the port, even if the last one locked it and was killed.

        Exclusive mode belongs to the terminal and outlives whoever set it, as long as the terminal
        lives; a real port would be closed by then.
        """
        if self.plugged:
            fcntl.ioctl(self._host_end, termios.TIOCNXCL)


def _point(link: Path, target: str) -> None:
    """Make `link` lead to `target` in one step, so that nobody ever finds half of it."""
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
