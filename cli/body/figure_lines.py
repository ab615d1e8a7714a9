"""Figures as readable lines; JSON has all digits."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

# Numbers below this share of the largest in their row or table are rounding.
NOTHING = 1e-9


def as_lines(figures: dict[str, object]) -> str:
    """Figures one a line, without empty ones; numbers to six digits."""
    known = {name: value for name, value in figures.items() if value is not None and value != []}
    width = max(map(len, known), default=0)
    return "\n".join(f"{_words(name):{width}}  {_text(value)}" for name, value in known.items())


def _words(name: str) -> str:
    """The name of a figure as it is read: of `p99_9` the point, too."""
    return re.sub(r"(?<=\d)_(?=\d)", ".", name).replace("_", " ")


def _text(value: object) -> str:
    match value:
        case bool():
            return "yes" if value else "no"
        case float():
            return f"{value:.6g}"
        case dict() if not value:
            return "none"
        case dict():
            return ", ".join(f"{_words(name)} {_text(one)}" for name, one in value.items())
        case list() if _is_numeric(value):
            return _rows(_without_rounding(np.array(value)))
        case list():
            return ", ".join(map(_text, value))
        case _:
            return str(value)


def _is_numeric(values: list[object]) -> bool:
    try:
        return np.array(values).dtype.kind in "if"
    except ValueError:
        return False


def _without_rounding(table: NDArray[Any]) -> NDArray[Any]:
    largest = np.abs(table).max(initial=0)
    kept: NDArray[Any] = np.where(np.abs(table) <= NOTHING * largest, 0, table)
    return kept


def _rows(table: NDArray[Any]) -> str:
    """Numbers separated by spaces, rows of a table by semicolons."""
    if table.ndim > 1:
        return "; ".join(map(_rows, table))
    return " ".join(map(_text, table.tolist()))
