"""Lease file that tells workers that their results are still wanted.

Its name ends in a word for the computer: what a killed process left is removed by the next one of
the same computer, which alone can tell that nobody holds it.
"""

from __future__ import annotations

import hashlib
import os
import platform
import re
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from ..files.atomic_file import atomic_file, refuse_unwritable
from ..files.held_lock import abandoned, hold, is_same_file
from ..files.windows.patience import remove_file

PREFIX = ".palpate-bake-"


@dataclass(frozen=True)
class Lease:
    """Small file in the folder of results that exists as long as they are wanted.

    A worker that sees it shares the folder with the waiting process, and stops when it is gone.

    Attributes
    ----------
    path : of the file.
    word : its contents, so that another machine's folder of the same name is not mistaken for it.
    """

    path: Path
    word: str

    def is_seen(self) -> bool:
        """Whether this process sees the same folder, and the results are still wanted."""
        try:
            return self.path.read_text(encoding="ascii") == self.word
        except (FileNotFoundError, PermissionError):
            # The latter on Windows from the removal until the last reader has closed the file.
            return False


def _withdraw(path: Path) -> None:
    """Make the lease unseen, then remove it.

    Windows lets nobody delete a file that a worker reads, but lets it be emptied.
    """
    with suppress(FileNotFoundError):
        os.truncate(path, 0)
        remove_file(path)


@contextmanager
def lease(folder: Path) -> Iterator[Lease]:
    """Hold a lease in ``folder``, which is made if missing.

    Raises
    ------
    UnwritableError
        The folder cannot be made or written.
    """
    word = secrets.token_hex(16)
    sign = Lease(folder / f"{PREFIX}{word[:8]}-{_computer()}", word)
    refuse_unwritable(sign.path)
    sweep_leases(folder)
    try:
        with _written(sign):
            yield sign
    finally:
        _withdraw(sign.path)


def sweep_leases(folder: Path) -> None:
    """Remove leases that killed processes of this computer left in ``folder``."""
    own = re.compile(rf"{re.escape(PREFIX)}[0-9a-f]{{8}}-{_computer()}")
    for path in folder.glob(f"{PREFIX}*"):
        if own.fullmatch(path.name):
            with abandoned(path) as nobody:
                if nobody:
                    path.unlink(missing_ok=True)


@contextmanager
def _written(sign: Lease) -> Iterator[None]:
    """The lease's file, held against :func:`sweep_leases`."""
    while True:
        with atomic_file(sign.path, make_folders=True) as file:
            file.write(sign.word.encode("ascii"))
        try:
            held = sign.path.open("rb")
        except FileNotFoundError:
            continue
        with held:
            hold(held.fileno())
            if is_same_file(held.fileno(), sign.path):
                yield
                return


def _computer() -> str:
    return hashlib.sha256(platform.node().encode()).hexdigest()[:8]
