"""The fault table."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """What was injected, how often, and what came out; forces in N."""

    injected: str
    times: int
    seen: str
    device: str
    broken: tuple[str, ...]
    """Rules that were broken, with how often."""
    at_cause: float | None = None
    """Largest output in the tick of the cause."""
    after: float | None = None
    """Largest output from the tick on in which it must be zero until it may come back."""
    ticks_to_zero: int | None = None
    back_ms: float | None = None
    """Until the whole force was back, at the longest."""


HEAD = ("injected", "times", "told", "at cause", "then", "to zero", "back in", "the device", "")


def print_rows(title: str, rows: list[Row]) -> None:
    """A table for people."""
    cells = [HEAD, *(_cells(row) for row in rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    print(f"\n{title}\n")
    for line in cells:
        print(
            "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        )


def _cells(row: Row) -> tuple[str, ...]:
    return (
        row.injected,
        str(row.times),
        row.seen,
        "" if row.at_cause is None else f"{row.at_cause:.3f} N",
        "" if row.after is None else f"{row.after:.3f} N",
        "" if row.ticks_to_zero is None else f"{row.ticks_to_zero} ticks",
        "" if row.back_ms is None else f"{row.back_ms:.0f} ms",
        row.device,
        f"FAILED: {', '.join(row.broken)}" if row.broken else "ok",
    )
