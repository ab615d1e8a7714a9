"""Run all that a release must hold, one after the other, and print a table of what came of it.

    python release/release_check.py

Goes on after what fails, so that one call tells all; ends with 1 if anything failed.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from blenders import blenders
from package_all import table

REPOSITORY = Path(__file__).resolve().parent.parent
REPORTS = REPOSITORY / "build" / "reports"
WINDOWS = ("native", "python", "addon")
HEADINGS = ("what", "outcome", "minutes", "closing line")


@dataclass(frozen=True)
class Step:
    """A command that must hold.

    Attributes
    ----------
    why_not : why it cannot be run here; empty where it can.
    """

    name: str
    command: tuple[str, ...]
    why_not: str = ""


@dataclass(frozen=True)
class Outcome:
    """What came of a step; wall time in seconds."""

    step: Step
    word: str
    seconds: float = 0.0
    closing_line: str = ""

    def row(self) -> tuple[str, ...]:
        """Return the columns of HEADINGS."""
        return (self.step.name, self.word, f"{self.seconds / 60:.1f}", self.closing_line)


def steps() -> list[Step]:
    """Return all steps, the short ones first."""
    under_wine = "" if os.name == "posix" and os.geteuid() == 0 else "needs root"
    return [
        Step("version", (sys.executable, "release/version.py")),
        *map(_make, ("lint", "test-native", "check-systems", "package-all")),
        *map(_make, ("test-core", "test-servo", "test-gui", "test-at-length", "demo")),
        *(_make(f"test-addon-{blender.version}") for blender in blenders()),
        *(_make(f"test-windows-{part}", under_wine) for part in WINDOWS),
    ]


def _make(target: str, why_not: str = "") -> Step:
    return Step(f"make {target}", ("make", target), why_not)


def outcome(step: Step, run: Callable[..., subprocess.CompletedProcess[str]]) -> Outcome:
    """Run a step, and show what it prints as it comes."""
    if step.why_not:
        return Outcome(step, "cannot be run here", closing_line=step.why_not)
    print(f"--- {step.name}", flush=True)
    # Parts of the tests keep one; not that of a run before this.
    report = REPORTS / f"{step.command[-1]}.txt"
    report.unlink(missing_ok=True)
    started = time.monotonic()
    done = run(step.command, cwd=REPOSITORY, check=False)
    seconds = time.monotonic() - started
    word = "passed" if done.returncode == 0 else "failed"
    return Outcome(step, word, seconds, _closing_line(report))


def _closing_line(report: Path) -> str:
    if not report.exists():
        return ""
    lines = report.read_text(encoding="utf-8", errors="replace").splitlines()
    return next((line for line in reversed(lines) if line.strip()), "")


def main(
    arguments: list[str] | None = None,
    run: Callable[..., subprocess.CompletedProcess[str]] = subprocess.run,
) -> int:
    """Run the steps that are named, or all."""
    every = {step.name: step for step in steps()}
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("steps", nargs="*", metavar="STEP", help=", ".join(every))
    options = parser.parse_args(arguments)
    unknown = [name for name in options.steps if name not in every]
    if unknown:
        parser.error(f"no step {', '.join(unknown)}")
    outcomes = [outcome(every[name], run) for name in options.steps or every]
    print(table([HEADINGS, *(one.row() for one in outcomes)]))
    return int(any(one.word == "failed" for one in outcomes))


if __name__ == "__main__":
    raise SystemExit(main())
