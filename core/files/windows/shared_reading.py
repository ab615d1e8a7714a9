"""Reading that leaves others free to move and delete the file meanwhile.

So it is everywhere but on Windows, where the one who opens a file has to allow it.
"""

from __future__ import annotations

import ctypes
import os
import sys
from functools import cache
from pathlib import Path
from typing import IO

from .long_path import reaching

if sys.platform == "win32":
    import msvcrt

    # Of CreateFileW.
    GENERIC_READ = 0x80000000
    FILE_SHARE_READ, FILE_SHARE_WRITE, FILE_SHARE_DELETE = 1, 2, 4
    OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL = 3, 0x80
    INVALID_HANDLE = ctypes.c_void_p(-1).value

    @cache
    def _kernel32() -> ctypes.WinDLL:
        """Not Python's own call: up to 3.11 it takes the letters of a path for others."""
        library = ctypes.WinDLL("kernel32", use_last_error=True)
        library.CreateFileW.restype = ctypes.c_void_p
        library.CreateFileW.argtypes = (
            *(ctypes.c_wchar_p, ctypes.c_uint32, ctypes.c_uint32, ctypes.c_void_p),
            *(ctypes.c_uint32, ctypes.c_uint32, ctypes.c_void_p),
        )
        return library

    def _opened(path: Path) -> IO[bytes]:
        handle = _kernel32().CreateFileW(
            str(path),
            GENERIC_READ,
            FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
            None,
            OPEN_EXISTING,
            FILE_ATTRIBUTE_NORMAL,
            None,
        )
        if handle == INVALID_HANDLE:
            number = ctypes.get_last_error()
            raise OSError(None, ctypes.FormatError(number).strip(), str(path), number)
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
