"""Reading ``.npz`` archives that may be anything: damaged, foreign, or closed to this user."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib.npyio import NpzFile
from numpy.typing import NDArray

from .errors import PalpateError


class ArchiveError(PalpateError):
    """An archive that cannot be read. Its message names file and reason; the remedy is to add."""


def read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    """All arrays of the archive at ``path`` by name; members that are no arrays are left out.

    Raises
    ------
    ArchiveError
        It cannot be opened, or is damaged, cut short or no archive.
    """
    try:
        stream = path.open("rb")
    except OSError as problem:
        raise ArchiveError(f"{path}: cannot be opened ({problem.strerror})") from problem
    with stream:
        try:
            # Not numpy.load, which takes single arrays and pickles too, and leaves files open.
            with NpzFile(stream, allow_pickle=False) as archive:
                members: dict[str, Any] = {name: archive[name] for name in archive.files}
        except Exception as problem:  # zip, its packers and numpy's headers: each fails its own way
            raise ArchiveError(
                f"{path}: damaged, cut short or not an npz archive ({problem!r})"
            ) from problem
    return {name: array for name, array in members.items() if isinstance(array, np.ndarray)}
