"""Why a port cannot be used, in words with a remedy."""

from __future__ import annotations

import errno
import os
import re
import sys

import serial

from ..errors import PalpateError
from ..sentence import Sentence

_NO_SUCH_PORT = Sentence("there is no such port; plug the device in, or see 'palpate devices'")
_GONE = Sentence("it has gone or does not work; plug the device in again")
REASONS = {
    errno.ENOENT: _NO_SUCH_PORT,
    errno.ECONNREFUSED: _NO_SUCH_PORT,
    errno.EACCES: Sentence(
        "no permission to open it; on Linux add yourself to the group that owns it "
        "(often dialout) and log in again"
    ),
    errno.EPERM: Sentence("no permission to open it; ask whoever runs this computer"),
    errno.EBUSY: Sentence("in use by another program; close that program"),
    errno.ENOTTY: Sentence("not a serial port; see 'palpate devices' for those there are"),
    errno.ENXIO: Sentence("nothing is connected to it; plug the device in"),
    errno.EIO: _GONE,
    errno.ECONNRESET: _GONE,
}

# Ports there have no rights, only one owner at a time; and some names can be no file's.
OF_WINDOWS = {errno.EACCES: errno.EBUSY, errno.EINVAL: errno.ENOENT}


class PortError(PalpateError):
    """Unusable port; `reason` is the message without the port's name."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__("{path}: {reason}", path=named(path), reason=reason)
        self.reason = reason


def named(path: str) -> str:
    """A port's path as it is shown, none as the quotes around nothing."""
    return path or "''"


def _number_in_words(said: str) -> int | None:
    """What pyserial says without an errno: a lock, on POSIX, or the error of Windows, as `repr`."""
    of_windows = re.search(r"could not open port .*Error\((\d+), ", said)
    if of_windows:
        return int(of_windows[1])
    return errno.EBUSY if "lock" in said else None


def port_error(path: str, error: OSError) -> PortError:
    """Return why a port cannot be used, by what the system or pyserial says."""
    number = error.errno
    if isinstance(error, serial.SerialException) and number in (None, errno.EAGAIN):
        number = _number_in_words(str(error))
    if number is None:
        return PortError(
            path, Sentence("cannot be used ({error}); plug the device in again", error=error)
        )
    if sys.platform == "win32":
        number = OF_WINDOWS.get(number, number)
    unknown = Sentence(
        "cannot be opened ({reason}); plug the device in again", reason=os.strerror(number)
    )
    return PortError(path, REASONS.get(number, unknown))
