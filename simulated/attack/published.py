"""Tables in a document, between two lines that stay."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ...core.errors import PalpateError
from ...core.files.atomic_file import atomic_file
from .table import Table

VIRTUAL, REAL = "attack", "real attack"
"""Places in a document."""


def published(text: str, tables: Iterable[Table], place: str = VIRTUAL) -> str:
    """The document with these tables instead of what stood at this place.

    Raises PalpateError for a document without a place for them.
    """
    first, last = f"<!-- {place}: begin -->", f"<!-- {place}: end -->"
    before, begin, rest = text.partition(first)
    _, end, after = rest.partition(last)
    if not (begin and end):
        raise PalpateError(
            "no place for the tables; put a line {begin} and a line {end} there",
            begin=first,
            end=last,
        )
    lines = "\n\n".join("\n".join(table.lines()) for table in tables)
    return f"{before}{first}\n```text\n{lines}\n```\n{last}{after}"


def publish(path: Path, tables: Iterable[Table], place: str = VIRTUAL) -> None:
    """Put the tables into a document, at this place. Raises PalpateError, OSError."""
    text = published(path.read_text(encoding="utf-8"), tables, place)
    with atomic_file(path) as file:
        file.write(text.encode())
