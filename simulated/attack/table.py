"""The table of attacks: a row a kind, for people, for programs and for docs/safety.md."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """What was injected, how often, and what came out."""

    injected: str
    times: int
    told: str
    broken: tuple[str, ...]
    """Rules that were broken, with how often."""
    force: float | None = None
    """Largest force while there must be none, N."""
    frames: int | None = None
    """Messages with a force while there must be none."""
    felt: float | None = None
    """Largest force that the device's motors made at all, N."""
    slew: float | None = None
    """Largest growth of that, N/s."""
    zero_ms: float | None = None
    """From the cause to zero, at the longest."""
    back_ms: float | None = None
    """Until the whole force was back, at the longest."""
    note: str = ""


@dataclass(frozen=True)
class Table:
    """Rows of one attack."""

    title: str
    rows: tuple[Row, ...]

    @property
    def broken(self) -> bool:
        """Whether a rule was broken."""
        return any(row.broken for row in self.rows)

    def lines(self) -> Iterable[str]:
        """The table for people."""
        shown = [HEAD, *(cells(row) for row in self.rows)]
        widths = [max(map(len, column)) for column in zip(*shown, strict=True)]
        yield self.title
        yield ""
        for line in shown:
            columns = (cell.ljust(width) for cell, width in zip(line, widths, strict=True))
            yield "  ".join(columns).rstrip()


def is_chosen(injected: str, only: tuple[str, ...]) -> bool:
    """Whether a name has one of these parts; all have none."""
    return not only or any(part in injected for part in only)


HEAD = ("injected", "times", "told", "force", "frames", "motors", "slew", "to zero", "back in", "")


def counted(problems: dict[str, int]) -> tuple[str, ...]:
    """Rules that were broken, as a row has them."""
    return tuple(f"{rule} ({count})" for rule, count in problems.items())


def cells(row: Row) -> tuple[str, ...]:
    """What is shown of a row, a column each."""
    verdict = f"FAILED: {', '.join(row.broken)}" if row.broken else "ok"
    return (
        row.injected,
        str(row.times),
        row.told,
        _told(row.force, "{:.3f} N"),
        _told(row.frames, "{}"),
        _told(row.felt, "{:.2f} N"),
        _told(row.slew, "{:.0f} N/s"),
        _told(row.zero_ms, "{:.0f} ms"),
        _told(row.back_ms, "{:.0f} ms"),
        f"{verdict}; {row.note}" if row.note else verdict,
    )


def _told(value: float | None, form: str) -> str:
    return "" if value is None else form.format(value)
