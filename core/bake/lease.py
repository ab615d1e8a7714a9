"""Lease file that tells workers that their results are still wanted."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from ..files.atomic_file import atomic_file, refuse_unwritable
from ..files.patience import remove_file


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
    sign = Lease(folder / f".palpate-bake-{word[:8]}", word)
    refuse_unwritable(sign.path)
    with atomic_file(sign.path, make_folders=True) as file:
        file.write(word.encode("ascii"))
    try:
        yield sign
    finally:
        _withdraw(sign.path)
