"""Files that stand aside where Windows neither replaces nor deletes them because they are mapped.

What is mapped may be given another name there (:mod:`.shared_reading`), so that its own is free.
Once the last reader has let go, whoever writes in the folder next removes what stands aside.
"""

from __future__ import annotations

import re
import secrets
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from .long_path import reaching
from .patience import patiently

REPLACED, REMOVED = "palpate-replaced", "palpate-removed"
"""Ends of names: of what another file took the place of, and of what is gone."""
ASIDE = re.compile(rf"\.(?P<name>.+)\.[0-9a-f]{{8}}\.(?P<end>{REPLACED}|{REMOVED})")


def take_place(new: Path, target: Path, sleep: Callable[[float], None] = time.sleep) -> None:
    """Give ``new`` the name ``target``, whose file it replaces.

    In one step; in two where the file is mapped on Windows: who is killed between them leaves the
    older one to be put back by :func:`sweep_aside`.

    Raises
    ------
    OSError
        One of the two may not be moved; both are where they were.
    """
    patiently(lambda: _take_place(new, target), sleep)


def _take_place(new: Path, target: Path) -> None:
    try:
        new.replace(target)
    except PermissionError:
        # Where it is the new one that somebody holds, the other need not stand aside.
        new.rename(new)
        if not target.is_file():
            raise
        _exchange(new, target)


def _exchange(new: Path, target: Path) -> None:
    aside = _beside(target, REPLACED)
    target.rename(aside)
    try:
        new.replace(target)
    except OSError:
        aside.rename(target)
        raise
    _remove_if_free(aside)


def discard(path: Path, sleep: Callable[[float], None] = time.sleep) -> None:
    """Remove a file, if it is there. Its name is free at once, also while others read it.

    Raises
    ------
    OSError
        It may not be moved.
    """
    path = reaching(path)
    aside = _beside(path, REMOVED)
    with suppress(FileNotFoundError):
        patiently(lambda: path.rename(aside), sleep)
        _remove_if_free(aside)


def sweep_aside(folder: Path) -> None:
    """Remove what stands aside in ``folder`` and is free; put back what was not replaced."""
    for aside in folder.glob(".*.palpate-*"):
        if found := ASIDE.fullmatch(aside.name):
            target = aside.with_name(found["name"])
            if found["end"] == REPLACED and not target.exists():
                with suppress(OSError):
                    aside.rename(target)
            else:
                _remove_if_free(aside)


def _beside(path: Path, end: str) -> Path:
    return path.with_name(f".{path.name}.{secrets.token_hex(4)}.{end}")


def _remove_if_free(aside: Path) -> None:
    with suppress(PermissionError, FileNotFoundError):
        aside.unlink()
