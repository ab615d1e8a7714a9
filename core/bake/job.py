"""Bake in the background: started, polled, cancelled without remains."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from ..body import body_file
from ..body.soft_body import SoftBody
from ..compliance.mapped import MappedCompliance
from ..errors import PalpateError
from ..files import scratch_folder
from ..files.atomic_file import refuse_unwritable
from ..files.scratch_folder import ScratchFolder
from ..machine import c_runtime, run_module
from ..machine.ends_with_parent import end_with_this_process
from ..machine.remaining_time import RemainingTime
from ..mesh.fit import THICKNESS_DOUBTFUL, Fit, refuse_thin
from ..mesh.ftetwild_log import stage
from ..mesh.surface import Surface
from ..mesh.tet_mesh import TetMesh
from ..progress import unwatched
from ..sentence import Sentence
from .child import BODY_FILE, OUTCOME_FILE, PROGRESS_FILE
from .foreseen_share import ForeseenShare
from .lease import sweep_leases
from .request import BakeRequest
from .steps import BakeReport, BakeSettings

# More than the longest line of progress.
LINE_BYTES = 200
LOG_FILE = "log.txt"
# Of folders that killed processes may have left.
SCRATCH_WORDS = ("bake", "worker", "device", "animation")
STEP_TEXTS = {
    "start": "Starting",
    "tetrahedralize": "Filling with tetrahedra",
    "check": "Comparing with the mesh",
    "stiffness": "Assembling the stiffness",
    "plan": "Planning the elimination",
    "compliance": "Inverting the stiffness",
    "compress": "Compressing the compliance",
    "store": "Writing the body file",
}


@dataclass(frozen=True)
class JobProgress:
    """Progress of a job.

    Attributes
    ----------
    step, text : the step's identifier and its description.
    share : of the job done, 0 to 1; None if unknown.
    seconds : elapsed.
    remaining : seconds; None if unknown.
    """

    step: str
    text: Sentence
    share: float | None
    seconds: float
    remaining: float | None = None


class BakeJob:
    """Bake in a child process and a temporary folder, both removed when the job is closed.

    Parameters
    ----------
    source, settings, surface : as for :func:`palpate.core.bake.steps.bake`.
    python : how to start Python, for example ``(sys.executable, *bpy.app.python_args)``.

    Raises
    ------
    PalpateError
        Settings outside their range; Python cannot be started.
    """

    def __init__(
        self,
        source: Surface | TetMesh,
        settings: BakeSettings,
        surface: Surface | None = None,
        python: Sequence[str] = (sys.executable,),
    ) -> None:
        settings.checked()
        self._source, self._epsilon = source, settings.epsilon
        self._time_limit = settings.time_limit
        self._started = time.monotonic()
        self._remaining = RemainingTime()
        self._foreseen = ForeseenShare()
        scratch_folder.sweep(SCRATCH_WORDS)
        self._scratch = ScratchFolder("bake")
        self._folder = self._scratch.path
        try:
            BakeRequest(source, settings, surface).write(self._folder)
            self._child = self._start(python)
        except BaseException:
            self._scratch.remove()
            raise

    def poll(self) -> JobProgress:
        """Progress now.

        Raises
        ------
        PalpateError
            Tetrahedralization took longer than its time limit; the job is closed.
        """
        seconds = time.monotonic() - self._started
        step, share = self._newest_progress()
        text = Sentence(STEP_TEXTS[step])
        if step == "tetrahedralize":
            if seconds > self._time_limit and not self.finished:
                self.close()
                raise PalpateError(
                    "tetrahedralization: not done within {seconds:g} s; use a larger edge length "
                    "or epsilon, decimate the mesh first, or allow more time",
                    seconds=self._time_limit,
                )
            text = Sentence("{step}: {stage}", step=text, stage=stage(self._log()))
        return JobProgress(step, text, share, seconds, self._remaining.update(seconds, share))

    @property
    def finished(self) -> bool:
        """Whether the child has ended, successfully or not."""
        return self._child.poll() is not None

    def result(self, target: Path | Callable[[SoftBody], Path]) -> tuple[SoftBody, BakeReport]:
        """The body and the report of its bake; the body file replaces ``target`` atomically.

        Waits until the job has finished and closes it. The target may depend on the body: some
        systems refuse to rename a mapped file.

        Raises
        ------
        PalpateError
            The reason why the bake failed; no file is left.
        """
        try:
            self._child.wait()
            report = self._report()
            # Checked before it replaces another; loaded from its target, since a large one is
            # mapped, not read.
            found = body_file.load(self._folder / BODY_FILE)
            place = target(found) if callable(target) else target
            body_file.adopt(self._folder / BODY_FILE, place)
            # A body that was read needs nothing from the temporary folder.
            in_file = isinstance(found.compliance, MappedCompliance)
            body = body_file.load(place) if in_file else found
        finally:
            self.close()
        return body, report

    def close(self) -> None:
        """Stop the child if it still runs and remove the temporary folder. Safe to repeat."""
        if self._child.poll() is None:
            self._child.kill()
        self._child.wait()
        self._scratch.remove()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _start(self, python: Sequence[str]) -> subprocess.Popen[bytes]:
        context = {
            "path": sys.path,
            # For a parent that died unnoticed: twice the limit and an hour.
            "longest_seconds": 2 * self._time_limit + 3600,
        }
        (self._folder / "context.json").write_text(json.dumps(context), encoding="utf-8")
        command = [*python, *run_module.command("core.bake.child"), str(self._folder)]
        try:
            with (self._folder / LOG_FILE).open("wb") as log:
                child = subprocess.Popen(  # noqa: S603  our own script, by path
                    command,
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=subprocess.STDOUT,
                    env=c_runtime.for_a_child(),
                    creationflags=c_runtime.NO_WINDOW,
                )
        except OSError as problem:
            raise PalpateError(
                "bake: {program} cannot be started ({problem}); reinstall Blender or Python",
                program=command[0],
                problem=problem,
            ) from problem
        end_with_this_process(child)
        return child

    def _newest_progress(self) -> tuple[str, float | None]:
        file = self._folder / PROGRESS_FILE
        complete_lines = _end_of(file, 2 * LINE_BYTES).split("\n")[:-1] if file.exists() else []
        if not complete_lines:
            return "start", None
        step, share, *expected = json.loads(complete_lines[-1])
        if expected:
            share = self._foreseen.update(time.monotonic(), share, expected[0])
        return step, share

    def _log(self) -> str:
        file = self._folder / LOG_FILE
        return file.read_text(encoding="utf-8", errors="replace") if file.exists() else ""

    def _report(self) -> BakeReport:
        file = self._folder / OUTCOME_FILE
        if not file.exists():
            # A frequent reason for fTetWild to crash, which it cannot tell itself.
            if isinstance(self._source, Surface):
                refuse_thin(self._source.welded(), self._epsilon, THICKNESS_DOUBTFUL)
            last = " | ".join(self._log().strip().splitlines()[-3:])
            words = Sentence(", last words: {words}", words=last) if last else ""
            raise PalpateError(
                "bake: the process ended unexpectedly (exit status {status}{words}); use a larger "
                "edge length or epsilon, or clean the mesh (merge by distance, recalculate "
                "normals)",
                status=self._child.returncode,
                words=words,
            )
        outcome = json.loads(file.read_text(encoding="utf-8"))
        if "error" in outcome:
            raise PalpateError(Sentence.of_line(outcome["error"]))
        if "crash" in outcome:
            raise RuntimeError(f"the bake process failed:\n{outcome['crash']}")
        report = outcome["report"]
        fit = Fit.of_dict(report["fit"]) if report["fit"] else None
        return BakeReport(report["seconds"], fit, [*map(Sentence.of_line, report["warnings"])])


def _end_of(file: Path, count: int) -> str:
    """Last ``count`` bytes of a text file, or all of it."""
    with file.open("rb") as stream:
        stream.seek(0, 2)
        stream.seek(max(0, stream.tell() - count))
        return stream.read().decode("utf-8")


def run_bake(
    source: Surface | TetMesh,
    settings: BakeSettings,
    target: Path,
    on_progress: Callable[[JobProgress], None] = unwatched,
    surface: Surface | None = None,
    python: Sequence[str] = (sys.executable,),
) -> tuple[SoftBody, BakeReport]:
    """Bake in a child process and wait; parameters and errors as for :class:`BakeJob`.

    An exception from ``on_progress``, KeyboardInterrupt included, stops the child.
    """
    refuse_unwritable(target)
    sweep_leases(target.parent)
    with BakeJob(source, settings, surface, python) as job:
        while not job.finished:
            on_progress(job.poll())
            time.sleep(0.05)
        return job.result(target)
