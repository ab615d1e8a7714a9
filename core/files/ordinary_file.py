"""Files that can be read like any other."""

from __future__ import annotations

from pathlib import Path

from ..errors import PalpateError
from .windows.long_path import reaching


def refuse_missing(path: Path) -> None:
    """Refuse a path without a file, and folders, devices and pipes.

    Raises
    ------
    PalpateError
        It is none.
    """
    found = reaching(path)
    if found.is_file():
        return
    if found.exists():
        raise PalpateError(
            "{path}: is a folder, a device or a pipe; give an ordinary file", path=path
        )
    raise PalpateError("{path}: there is no such file; check the path", path=path)
