"""Run all that a release must hold, one after the other, and print two tables of what came of it.

    python release/release_check.py

Goes on after what fails, so that one call tells all, and ends with 1 if anything failed. What
passed is written down: a call that was broken off goes on where it was, as long as the commit is
the same and nothing has changed since. Steps that are named run alone, and two such calls may run
side by side: those under wine, for example, beside the packages.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

from blenders import blenders
from package_all import table
from platforms import PLATFORMS
from release_table import (
    CANNOT,
    FAILED,
    NOT_YET,
    PASSED,
    Cell,
    cells_of,
    closing_line,
    rows,
    verdict,
)

REPOSITORY = Path(__file__).resolve().parent.parent
REPORTS = REPOSITORY / "build" / "reports"
HEADINGS = ("what", "outcome", "minutes", "closing line")
HERE, UNDER_WINE = "linux-x64", "windows-x64"
Run = Callable[..., "subprocess.CompletedProcess[str]"]


@dataclass(frozen=True)
class Step:
    """A command that must hold.

    Attributes
    ----------
    shows : the cells of the table of systems that it speaks for.
    why_not : why it cannot be run here; empty where it can.
    """

    command: tuple[str, ...]
    shows: tuple[Cell, ...] = field(default=(), repr=False)
    why_not: str = ""

    @property
    def name(self) -> str:
        """The command as it is typed."""
        return " ".join(self.command)

    @property
    def report(self) -> Path:
        """Where its tests leave what they print."""
        return REPORTS / f"{self.command[1]}.txt"


@dataclass(frozen=True)
class Outcome:
    """What came of a step; wall time in seconds."""

    word: str
    seconds: float = 0.0
    closing_line: str = ""
    wrong: tuple[str, ...] = ()
    """Places in the table of systems that it speaks against."""


def steps() -> list[Step]:
    """Return all steps, the short ones first."""
    why_not = "" if os.name == "posix" and os.geteuid() == 0 else "needs root"
    every = [blender.version for blender in blenders()]
    return [
        Step((Path(sys.executable).name, "release/version.py")),
        *(Step(("make", name)) for name in ("lint", "check-systems", "test-gui")),
        *(_package(platform) for platform in PLATFORMS),
        *(
            Step(("make", f"test-{part}"), cells_of(HERE, ["servo"]))
            for part in ("native", "servo")
        ),
        Step(("make", "test-core"), cells_of(HERE, ["core"])),
        *(Step(("make", f"test-addon-{one}"), _installed(HERE, one)) for one in every),
        *(Step(("make", "demo", f"BPY={one}"), cells_of(HERE, ["demo"], one)) for one in every),
        Step(("make", "test-windows-native"), cells_of(UNDER_WINE, ["servo"]), why_not),
        _in_windows("servo", "tests/servo", why_not),
        _in_windows("core", "tests/core tests/cli tests/simulated", why_not),
        *(
            Step(("make", f"test-windows-addon-{one}"), _installed(UNDER_WINE, one), why_not)
            for one in every
        ),
        *(
            Step(("make", f"demo-windows-{one}"), cells_of(UNDER_WINE, ["demo"], one), why_not)
            for one in every
        ),
        Step(("make", "test-at-length")),
    ]


def _package(platform: str) -> Step:
    return Step(("make", "package-all", f"SYSTEMS={platform}"), cells_of(platform, ["builds"]))


def _in_windows(column: str, tests: str, why_not: str) -> Step:
    command = ("make", "test-windows-python", f"WINDOWS_TESTS={tests}")
    return Step(command, cells_of(UNDER_WINE, [column]), why_not)


def _installed(platform: str, blender: str) -> tuple[Cell, ...]:
    tests = "tests/addon/test_installation.py"
    return (
        *cells_of(platform, ["installs"], blender, tests),
        *cells_of(platform, ["imports"], blender, f"{tests}::test_import"),
        *cells_of(platform, ["imports"], blender, f"{tests}::test_every_module"),
        *cells_of(platform, ["add-on"], blender),
    )


def outcome(step: Step, run: Run) -> Outcome:
    """Run a step, and show what it prints as it comes."""
    if step.why_not:
        return Outcome(CANNOT, closing_line=step.why_not)
    print(f"--- {step.name}", flush=True)
    # Parts of the tests keep one; not that of a run before this.
    step.report.unlink(missing_ok=True)
    started = time.monotonic()
    done = run(step.command, cwd=REPOSITORY, check=False)
    seconds = time.monotonic() - started
    word = PASSED if done.returncode == 0 else FAILED
    report = _read(step.report)
    against = tuple(cell.place for cell in step.shows if verdict(word, cell, report) == FAILED)
    return Outcome(word, seconds, closing_line(report), against)


def _read(report: Path) -> str:
    return report.read_text(encoding="utf-8", errors="replace") if report.exists() else ""


def commit() -> str:
    """Return the commit; nothing where files differ from it, since no outcome holds then."""
    git = ("git", "-C", str(REPOSITORY))
    said = [
        subprocess.run((*git, *words), check=False, capture_output=True, text=True)
        for words in (("rev-parse", "HEAD"), ("status", "--porcelain"))
    ]
    if any(one.returncode for one in said) or said[1].stdout.strip():
        return ""
    return said[0].stdout.strip()


def _kept(place: Path, of: str) -> dict[str, Outcome]:
    """What is written down of steps of a commit."""
    if not of or not place.exists():
        return {}
    found = json.loads(place.read_text(encoding="utf-8"))
    if found["commit"] != of:
        return {}
    outcomes = found["outcomes"].items()
    return {name: Outcome(**one | {"wrong": tuple(one["wrong"])}) for name, one in outcomes}


def _keep(place: Path, of: str, outcomes: Mapping[str, Outcome]) -> None:
    place.parent.mkdir(parents=True, exist_ok=True)
    kept = {"commit": of, "outcomes": {name: asdict(one) for name, one in outcomes.items()}}
    place.write_text(json.dumps(kept, indent=1), encoding="utf-8")


def told(every: Iterable[Step], outcomes: Mapping[str, Outcome]) -> str:
    """Return both tables: of the steps, and of the systems."""
    of_steps: list[tuple[str, ...]] = [HEADINGS]
    said: dict[str, list[str]] = {}
    for step in every:
        one = outcomes.get(step.name, Outcome(NOT_YET))
        of_steps.append((step.name, one.word, f"{one.seconds / 60:.1f}", one.closing_line))
        for cell in step.shows:
            holds = one.word == FAILED and cell.place not in one.wrong
            said.setdefault(cell.place, []).append(PASSED if holds else one.word)
    return f"{table(of_steps)}\n\n{table(rows(said))}"


def main(arguments: list[str] | None = None, run: Run = subprocess.run) -> int:
    """Run the steps that are named, or all that have not passed yet on this commit."""
    every = {step.name: step for step in steps()}
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("steps", nargs="*", metavar="STEP", help=", ".join(every))
    options = parser.parse_args(arguments)
    unknown = [name for name in options.steps if name not in every]
    if unknown:
        parser.error(f"no step {', '.join(unknown)}")
    place, of = REPORTS / "release-check.json", commit()
    outcomes = _kept(place, of)
    not_yet = [name for name in every if outcomes.get(name, Outcome(NOT_YET)).word != PASSED]
    for name in options.steps or not_yet:
        came_to = outcome(every[name], run)
        # What a call beside this one has written down since stays.
        outcomes |= _kept(place, of) | {name: came_to}
        _keep(place, of, outcomes)
    print(told(every.values(), outcomes))
    return int(any(one.word == FAILED for one in outcomes.values()))


if __name__ == "__main__":
    raise SystemExit(main())
