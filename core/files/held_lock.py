"""Locks that the system frees when a process ends, however it ends."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows, where a file that is open cannot be deleted
    fcntl = None  # type: ignore[assignment]


def hold(descriptor: int) -> None:
    """Lock an open file against :func:`abandoned` until it is closed or the process ends.

    Several processes may hold it. Some network file systems have no locks: nothing is held there,
    and nothing is found abandoned.
    """
    if fcntl is not None:
        with suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_SH)


def is_same_file(descriptor: int, path: Path) -> bool:
    """Whether ``path`` still leads to the open file: not if it was swept before it was held."""
    try:
        return os.path.samestat(os.fstat(descriptor), path.lstat())
    except FileNotFoundError:
        return False


@contextmanager
def abandoned(path: Path) -> Iterator[bool]:
    """Whether nobody holds the file at ``path``, of this user; stays so during the block."""
    if fcntl is None:
        yield _is_deletable(path)
        return
    try:
        descriptor = os.open(path, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        yield False
        return
    try:
        yield os.fstat(descriptor).st_uid == os.getuid() and _takes(descriptor)
    finally:
        os.close(descriptor)


def _takes(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _is_deletable(path: Path) -> bool:
    try:
        path.rename(path)
    except OSError:
        return False
    return True
