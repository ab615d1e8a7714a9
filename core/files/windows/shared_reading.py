"""Reading that leaves others free to move and delete the file meanwhile.

So it is everywhere but on Windows, where the one who opens a file has to allow it.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import IO

from .long_path import reaching

if sys.platform == "win32":
    import _winapi
    import msvcrt

    # Of CreateFile.
    FILE_SHARE_READ, FILE_SHARE_WRITE, FILE_SHARE_DELETE = 1, 2, 4
    FILE_ATTRIBUTE_NORMAL = 0x80

    def _opened(path: Path) -> IO[bytes]:
        handle = _winapi.CreateFile(
            str(path),
            _winapi.GENERIC_READ,
            FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
            _winapi.NULL,
            _winapi.OPEN_EXISTING,
            FILE_ATTRIBUTE_NORMAL,
            _winapi.NULL,
        )
        return os.fdopen(msvcrt.open_osfhandle(handle, os.O_RDONLY | os.O_BINARY), "rb")

else:

    def _opened(path: Path) -> IO[bytes]:
        return path.open("rb")


def open_shared(path: Path) -> IO[bytes]:
    """Open a file to be read.

    Raises
    ------
    OSError
        It is not there, or may not be read.
    """
    return _opened(reaching(path))
