"""Files of Palpate's own, recognised by what they begin with, not by their names."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import numpy as np

from .windows.long_path import reaching
from .windows.shared_reading import open_shared

# The first array of an archive by `npz_archive.write_arrays` ends within these bytes.
HEAD_BYTES = 512
ARCHIVE_MAGIC = b"PK\x03\x04"
FIRST_MEMBER = b"format.npy"
FIRST_MEMBER_AT = 30


def is_ordinary(path: Path) -> bool:
    """Whether a file is there that is neither a link nor a folder, device or pipe."""
    try:
        return stat.S_ISREG(os.lstat(reaching(path)).st_mode)
    except (OSError, ValueError):
        return False


def is_own(path: Path, word: str) -> bool:
    """Whether an ordinary file begins as an archive whose first array, ``format``, is ``word``.

    Also where the rest is damaged or cut short. Links are not followed.
    """
    if not is_ordinary(path):
        return False
    try:
        with open_shared(path) as file:
            head = file.read(HEAD_BYTES)
    except OSError:
        return False
    is_archive = head.startswith(ARCHIVE_MAGIC)
    is_format = head.startswith(FIRST_MEMBER, FIRST_MEMBER_AT)
    return is_archive and is_format and np.array(word).tobytes() in head


def is_free(path: Path, word: str) -> bool:
    """Whether a file of Palpate's may be written here: nothing is there, or such a file."""
    return not os.path.lexists(reaching(path)) or is_own(path, word)


def stays_within(folder: Path, parent: Path) -> bool:
    """Whether ``folder``, should it be a link, leads to a place inside of ``parent``."""
    real = Path(os.path.realpath(folder))
    return real.is_relative_to(os.path.realpath(parent))
