"""Temporary folders that the next process removes if theirs was killed."""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Self

from .held_lock import abandoned, hold, is_same_file
from .windows.patience import remove_folder

PREFIX = "palpate-"
LOCK_FILE = "in-use.lock"
# Folders without a lock are of older versions, or were made a moment ago.
SECONDS_WITHOUT_LOCK = 24 * 3600


class ScratchFolder:
    """Temporary folder, held by a lock that the system frees with this process.

    Attributes
    ----------
    path : of the folder.
    """

    def __init__(self, word: str) -> None:
        """Make a folder ``palpate-<word>-*`` among the temporary files."""
        while True:
            self.path = Path(tempfile.mkdtemp(prefix=f"{PREFIX}{word}-"))
            self._lock = held(self.path)
            if is_same_file(self._lock, self.path / LOCK_FILE):
                return
            os.close(self._lock)

    def remove(self) -> None:
        """Remove the folder. Safe to repeat."""
        _empty(self.path)
        if self._lock >= 0:
            os.close(self._lock)
            self._lock = -1
        remove_folder(self.path)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.remove()


def held(folder: Path) -> int:
    """Hold the lock of a folder, also for a child process; returns its descriptor."""
    descriptor = os.open(folder / LOCK_FILE, os.O_CREAT | os.O_RDWR, 0o600)
    hold(descriptor)
    return descriptor


def sweep(words: tuple[str, ...], parent: Path | None = None) -> list[Path]:
    """Remove folders ``palpate-<word>-*`` of killed processes of this user; returns their paths.

    A folder whose process lives is never touched, nor a link, nor another user's.
    """
    place = Path(tempfile.gettempdir()) if parent is None else parent
    found = (path for word in words for path in place.glob(f"{PREFIX}{word}-*"))
    return [path for path in found if _is_ours(path) and _swept(path)]


def _is_ours(path: Path) -> bool:
    if path.is_symlink() or not path.is_dir():
        return False
    return not hasattr(os, "getuid") or path.lstat().st_uid == os.getuid()


def _swept(path: Path) -> bool:
    lock = path / LOCK_FILE
    if not os.path.lexists(lock):
        is_old = time.time() - path.lstat().st_mtime > SECONDS_WITHOUT_LOCK
        if is_old:
            shutil.rmtree(path, ignore_errors=True)
        return is_old
    with abandoned(lock) as nobody:
        if nobody:
            _remove_lock_last(path)
        return nobody


def _remove_lock_last(folder: Path) -> None:
    _empty(folder)
    shutil.rmtree(folder, ignore_errors=True)


def _empty(folder: Path) -> None:
    """Remove all but the lock: whoever is killed meanwhile leaves a folder that is swept again."""
    for entry in folder.iterdir() if folder.is_dir() else ():
        if entry.name != LOCK_FILE and entry.is_dir() and not entry.is_symlink():
            shutil.rmtree(entry, ignore_errors=True)
        elif entry.name != LOCK_FILE:
            with suppress(OSError):
                entry.unlink()
