"""Rows of an attack that takes hours, in a file: one that was broken off goes on where it was."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path

from ...core.errors import PalpateError
from ...core.files.atomic_file import atomic_file
from .table import Row


def kept_rows(path: Path, times: int) -> dict[str, Row]:
    """Rows by what was injected; none without a file. Raises OSError.

    PalpateError for a file with other than such rows, or rows of another `--times`.
    """
    if not path.exists():
        return {}
    try:
        kept = json.loads(path.read_text(encoding="utf-8"))
        asked = int(kept["times"])
        rows = [Row(**{**row, "broken": tuple(row["broken"])}) for row in kept["rows"]]
    except (ValueError, TypeError, KeyError) as error:
        raise PalpateError(
            "{path}: no rows of an attack; name another file to keep them in", path=path
        ) from error
    if asked != times:
        raise PalpateError(
            "{path}: its rows were tried {asked} times each; go on with --times {asked}, or name "
            "another file",
            path=path,
            asked=asked,
        )
    return {row.injected: row for row in rows}


def keep_rows(path: Path, times: int, rows: Mapping[str, Row]) -> None:
    """Put rows into that file, in one step. Raises OSError."""
    told = {"times": times, "rows": [dataclasses.asdict(row) for row in rows.values()]}
    with atomic_file(path) as file:
        file.write(json.dumps(told, indent=1).encode())
