"""Lease file that tells workers that their results are still wanted."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ..files.atomic_file import atomic_file, refuse_unwritable


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
        except FileNotFoundError:
            return False


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
        sign.path.unlink(missing_ok=True)
