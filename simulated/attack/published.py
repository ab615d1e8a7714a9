"""Tables in a document, between two lines that stay."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ...core.errors import PalpateError
from ...core.files.atomic_file import atomic_file
from .table import Table

BEGIN = "<!-- attack: begin -->"
END = "<!-- attack: end -->"


def published(text: str, tables: Iterable[Table]) -> str:
    """The document with these tables instead of what stood there.

    Raises PalpateError for a document without a place for them.
    """
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise PalpateError(
            "no place for the tables; put a line {begin} and a line {end} there",
            begin=BEGIN,
            end=END,
        )
    lines = "\n\n".join("\n".join(table.lines()) for table in tables)
    return f"{before}{BEGIN}\n```text\n{lines}\n```\n{END}{after}"


def publish(path: Path, tables: Iterable[Table]) -> None:
    """Put the tables into a document. Raises PalpateError, OSError."""
    text = published(path.read_text(encoding="utf-8"), tables)
    with atomic_file(path) as file:
        file.write(text.encode())
