"""Atomic writing of files."""

from __future__ import annotations

import glob
import os
import re
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from ..errors import PalpateError
from .held_lock import abandoned, hold, is_same_file
from .windows.long_path import reaching
from .windows.patience import remove_file
from .windows.set_aside import sweep_aside, take_place

UNFINISHED = ".tmp"
UNFINISHED_WORD = re.compile(r"\.[0-9a-f]{8}\.tmp")


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
    found = reaching(target)
    folder = next(parent for parent in found.parents if parent.exists())
    if found.is_dir():
        raise UnwritableError("{target}: is a folder; name a file in it", target=target)
    if found.exists() and not found.is_file():
        raise UnwritableError("{target}: is no ordinary file; choose another name", target=target)
    if not folder.is_dir():
        raise UnwritableError(
            "{target}: cannot be written ({folder} is not a folder); choose another folder",
            target=target,
            folder=folder,
        )
    if not os.access(folder, os.W_OK | os.X_OK):
        raise UnwritableError(
            "{target}: cannot be written ({folder} may not be written); choose a folder you may "
            "write to",
            target=target,
            folder=folder,
        )


def refuse_missing_folder(target: Path) -> None:
    """Check that the folder of ``target`` exists, where none is to be made.

    Raises
    ------
    UnwritableError
        It does not.
    """
    folder = target.absolute().parent
    if not reaching(folder).exists():
        raise UnwritableError(
            "{target}: there is no folder {folder}; make it first", target=target, folder=folder
        )


@contextmanager
def atomic_file(
    target: Path, *, make_folders: bool = False, follows_links: bool = True
) -> Iterator[IO[bytes]]:
    """New file that replaces ``target`` when the block succeeds, and is deleted otherwise.

    A symbolic link is followed, unless told otherwise: then the file takes the link's place.
    Unfinished files that killed processes left of the same target are removed.

    Raises
    ------
    UnwritableError
        As for :func:`refuse_unwritable`, and when writing fails; an older file stays as it was.
    """
    refuse_unwritable(target)
    target = _followed(target) if follows_links else target
    place = reaching(target)
    unfinished = None
    try:
        if make_folders:
            place.parent.mkdir(parents=True, exist_ok=True)
        sweep_aside(place.parent)
        _sweep(place)
        unfinished, begun = _begun(place)
        with begun as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        take_place(unfinished, place)
    except OSError as problem:
        raise UnwritableError(
            "{target}: cannot be written ({reason}); choose a folder you may write to, with "
            "enough room",
            target=target,
            reason=problem.strerror or problem,
        ) from problem
    finally:
        if unfinished is not None:
            remove_file(unfinished)


def _begun(target: Path) -> tuple[Path, IO[bytes]]:
    """A new file beside the target, held against :func:`_sweep`."""
    while True:
        path = target.with_name(f".{target.name}.{secrets.token_hex(4)}{UNFINISHED}")
        file = path.open("xb")
        hold(file.fileno())
        if is_same_file(file.fileno(), path):
            return path, file
        file.close()


def _sweep(target: Path) -> None:
    """Remove what killed processes left unfinished of the target; a living one holds its file."""
    for unfinished in target.parent.glob(f".{glob.escape(target.name)}.*{UNFINISHED}"):
        if UNFINISHED_WORD.fullmatch(unfinished.name.removeprefix(f".{target.name}")):
            with abandoned(unfinished) as nobody:
                if nobody:
                    unfinished.unlink(missing_ok=True)


def _followed(target: Path) -> Path:
    # Before Python 3.13 Path.resolve raises on circular links.
    return Path(os.path.realpath(target)) if target.is_symlink() else target.absolute()
