"""Atomic writing of files."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from ..errors import PalpateError
from ..sentence import Sentence


class UnwritableError(PalpateError):
    """A target that cannot be written."""


def refuse_unwritable(target: Path) -> None:
    """Check that ``target`` could be written, before the work for it is spent.

    Raises
    ------
    UnwritableError
        The target is a folder or a device, or its folder cannot be made or written.
    """
    target = _followed(target)
    folder = next(parent for parent in target.parents if parent.exists())
    if target.is_dir():
        reason = Sentence("it is a folder")
    elif target.exists() and not target.is_file():
        reason = Sentence("it is no ordinary file")
    elif not folder.is_dir():
        reason = Sentence("{folder} is not a folder", folder=folder)
    elif not os.access(folder, os.W_OK | os.X_OK):
        reason = Sentence("{folder} may not be written", folder=folder)
    else:
        return
    raise UnwritableError(
        "{target}: cannot be written ({reason}); choose a folder you may write to",
        target=target,
        reason=reason,
    )


def refuse_missing_folder(target: Path) -> None:
    """Check that the folder of ``target`` exists, where none is to be made.

    Raises
    ------
    UnwritableError
        It does not.
    """
    folder = target.absolute().parent
    if not folder.exists():
        raise UnwritableError(
            "{target}: there is no folder {folder}; make it first", target=target, folder=folder
        )


@contextmanager
def atomic_file(target: Path, *, make_folders: bool = False) -> Iterator[IO[bytes]]:
    """New file that replaces ``target`` when the block succeeds, and is deleted otherwise.

    A symbolic link is followed.

    Raises
    ------
    UnwritableError
        As for :func:`refuse_unwritable`, and when writing fails; an older file stays as it was.
    """
    refuse_unwritable(target)
    target = _followed(target)
    unfinished = target.with_name(f".{target.name}.{secrets.token_hex(4)}.tmp")
    try:
        if make_folders:
            target.parent.mkdir(parents=True, exist_ok=True)
        with unfinished.open("xb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(target)
    except OSError as problem:
        raise UnwritableError(
            "{target}: cannot be written ({reason}); choose a folder you may write to, with "
            "enough room",
            target=target,
            reason=problem.strerror or problem,
        ) from problem
    finally:
        unfinished.unlink(missing_ok=True)


def _followed(target: Path) -> Path:
    # Before Python 3.13 Path.resolve raises on circular links.
    return Path(os.path.realpath(target))
