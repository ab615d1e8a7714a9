"""Child process of one bake, which can be stopped at any moment.

Started by ``run_module.py``. Modules that need numpy are imported once the parent's path is known.
"""

import ctypes
import faulthandler
import json
import os
import signal
import sys
import time
import traceback
from pathlib import Path
from typing import TextIO

PROGRESS_FILE = "progress.jsonl"
BODY_FILE = "body.npz"
OUTCOME_FILE = "outcome.json"
SECONDS_BETWEEN_LINES = 0.05
LINUX_PR_SET_PDEATHSIG = 1


def die_with_parent(longest_seconds: float) -> None:
    """End with the parent: by the kernel on Linux, elsewhere by a timer at the latest."""
    faulthandler.dump_traceback_later(longest_seconds, exit=True)
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(LINUX_PR_SET_PDEATHSIG, signal.SIGKILL)


class ProgressLines:
    """Progress as lines of a file: each new step, and its share several times a second."""

    def __init__(self, lines: TextIO) -> None:
        self._lines = lines
        self._step = ""
        self._next = 0.0

    def foresee(self, step: str, until: float, seconds: float) -> None:
        """Write what the parent shows while a step reports nothing itself."""
        self._step = ""
        print(json.dumps([step, until, seconds]), file=self._lines)

    def add(self, step: str, share: float | None) -> None:
        """Write a line, unless one for the same step was just written."""
        now = time.monotonic()
        if step != self._step or now >= self._next:
            self._step, self._next = step, now + SECONDS_BETWEEN_LINES
            print(json.dumps([step, share]), file=self._lines)


def run(folder: Path) -> dict[str, object]:
    """Bake the request in the folder and store the outcome."""
    from ..body import body_file
    from ..errors import PalpateError
    from .request import BakeRequest
    from .steps import bake

    request = BakeRequest.read(folder)
    with (folder / PROGRESS_FILE).open("a", encoding="utf-8", buffering=1) as lines:
        told = ProgressLines(lines)
        progress = told.add
        try:
            body, report = bake(
                request.source,
                request.settings,
                progress,
                request.surface,
                foresee=told.foresee,
            )
            progress("store", 1.0)
            body_file.save(body, folder / BODY_FILE)
        except PalpateError as problem:
            return {"error": problem.sentence.as_line()}
    warnings = [warning.as_line() for warning in report.warnings]
    return {"report": {**report.as_dict(), "warnings": warnings}}


def out_of_memory() -> str:
    """Error for a bake that ran out of memory."""
    from ..sentence import Sentence

    return Sentence(
        "bake: the memory does not suffice for this many surface nodes; choose the compressed form "
        "or use a larger edge length"
    ).as_line()


def main() -> int:
    """Entry point; the only argument is the folder."""
    folder = Path(sys.argv[1])
    context = json.loads((folder / "context.json").read_text(encoding="utf-8"))
    die_with_parent(context["longest_seconds"])
    # fTetWild writes files into the working directory.
    os.chdir(folder)
    sys.path[:] = context["path"]
    from ..files.scratch_folder import held

    held(folder)
    try:
        outcome = run(folder)
    except MemoryError:
        outcome = {"error": out_of_memory()}
    except Exception:  # noqa: BLE001  the parent raises it again, with this traceback
        outcome = {"crash": traceback.format_exc()}
    (folder / OUTCOME_FILE).write_text(json.dumps(outcome), encoding="utf-8")
    return 0
