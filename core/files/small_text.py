"""Small text files that a person wrote or was sent: settings and scripts."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..errors import PalpateError
from .windows.shared_reading import open_shared


def read_small_text(path: Path, most_bytes: int) -> str:
    """Text of a file of at most ``most_bytes``, of which no more is read.

    Raises
    ------
    PalpateError
        The file cannot be opened or is larger.
    ValueError
        It is no UTF-8.
    """
    try:
        with open_shared(path) as stream:
            content = stream.read(most_bytes + 1)
    except OSError as problem:
        raise PalpateError(
            "{path}: cannot be read ({reason}); check the path", path=path, reason=problem.strerror
        ) from problem
    if len(content) > most_bytes:
        raise PalpateError(
            "{path}: is larger than {most:g} MB, and no such file is; choose another",
            path=path,
            most=most_bytes / 1e6,
        )
    return content.decode("utf-8")


def json_value(text: str) -> Any:
    """Value of a JSON text.

    Raises
    ------
    ValueError
        It is none, or nested too deeply to be one of Palpate's.
    """
    try:
        return json.loads(text)
    except RecursionError as problem:
        raise ValueError("its brackets are nested too deeply") from problem
