"""The table of a release: of each system and Blender, what was shown to hold there."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from blenders import blenders
from platforms import PLATFORMS

COLUMNS = ("builds", "installs", "imports", "core", "add-on", "servo", "demo")
PASSED, FAILED, CANNOT, NOT_YET = "passed", "failed", "cannot", "not yet"
# From the worst: a cell says the first that any of its steps came to.
GRAVITY = (FAILED, NOT_YET, CANNOT, PASSED)


@dataclass(frozen=True)
class Cell:
    """A cell of the table that a step speaks for.

    Attributes
    ----------
    platform, blender, column : of the table; the Blender by its version.
    tests : how those tests begin that it speaks for; all of the step's where empty.
    """

    platform: str
    blender: str
    column: str
    tests: str = ""

    @property
    def place(self) -> str:
        """Where in the table it is; cells that differ in nothing but their tests are one there."""
        return f"{self.platform} {self.blender} {self.column}"


def cells_of(
    platform: str, columns: Iterable[str], blender: str = "", tests: str = ""
) -> tuple[Cell, ...]:
    """Return cells of one Blender, or of all that there are for a platform."""
    versions = [one.version for one in blenders() if platform in one.platforms]
    return tuple(
        Cell(platform, version, column, tests)
        for version in versions
        if blender in ("", version)
        for column in columns
    )


def verdict(word: str, cell: Cell, report: str) -> str:
    """Return what a step says of one of its cells.

    Parameters
    ----------
    word : what came of the whole step.
    report : what its tests have printed; pytest names at the end what failed.
    """
    if word != FAILED or not cell.tests or " passed" not in report:
        return word
    wrong = (f"FAILED {cell.tests}", f"ERROR {cell.tests}")
    return FAILED if any(line.startswith(wrong) for line in report.splitlines()) else PASSED


def closing_line(report: str) -> str:
    """Return how a report ends, what Blender says after its tests left out; of cargo, which closes
    each of its programs, the sum of all.
    """
    of_cargo = re.findall(r"^test result: \w+\. (\d+) passed; (\d+) failed", report, re.MULTILINE)
    if of_cargo:
        passed, failed = (sum(map(int, numbers)) for numbers in zip(*of_cargo, strict=True))
        return f"{passed} passed, {failed} failed"
    lines = [line for line in report.splitlines() if line.strip()]
    of_pytest = [
        line for line in lines if re.match(r"\d+ (passed|failed|error).* in [\d.]+s", line)
    ]
    return (of_pytest or lines or [""])[-1]


def rows(said: Mapping[str, list[str]]) -> list[tuple[str, ...]]:
    """Return the table, headings first, from what the steps said of each place."""
    found: list[tuple[str, ...]] = [("system", "Blender", *COLUMNS)]
    for platform in PLATFORMS:
        for blender in blenders():
            if platform in blender.platforms:
                places = [Cell(platform, blender.version, column).place for column in COLUMNS]
                words = [_worst(said.get(place, [])) for place in places]
                found.append((platform, blender.version, *words))
    return found


def _worst(words: list[str]) -> str:
    return min(words, key=GRAVITY.index, default=CANNOT)
