"""Bakes of many bodies on any ``concurrent.futures`` executor: threads, processes, a cluster.

Every bake has a child process of its own (:mod:`.job`), whatever the worker: a mesh that crashes
fTetWild does not crash the worker, a time limit holds, and on one machine threads suffice.

A worker with access to the folder of results writes there itself; otherwise (a cluster without a
common file system) it returns the file, and this process writes it.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ..errors import CancelledError, PalpateError
from ..files.atomic_file import UnwritableError, atomic_file
from ..files.scratch_folder import ScratchFolder
from ..mesh.surface import Surface
from ..mesh.tet_mesh import TetMesh
from ..progress import unwatched
from .job import run_bake
from .lease import Lease, lease
from .steps import BakeReport, BakeSettings

# Seconds between calls of `on_wait`, and between a worker's checks whether it is still wanted.
LOOK_UP_SECONDS = 0.2

# Seconds for cancelled bakes to stop.
STOP_SECONDS = 10.0


@dataclass(frozen=True, eq=False)
class BakeTask:
    """Body to bake.

    Attributes
    ----------
    name : in messages, for example the mesh's file.
    file_name : of the body file, in the folder of results.
    source, settings, surface : as for :func:`palpate.core.bake.steps.bake`.
    """

    name: str
    file_name: str
    source: Surface | TetMesh
    settings: BakeSettings
    surface: Surface | None = None


@dataclass(frozen=True)
class BakeOutcome:
    """Outcome of a task.

    Attributes
    ----------
    name : the task's.
    path : the body file, None if there is none.
    nodes, free_surface_nodes, form : the body's sizes and the form of its compliance.
    report : of the bake.
    error : one line on why the bake failed, None if it did not.
    """

    name: str
    path: Path | None = None
    nodes: int = 0
    free_surface_nodes: int = 0
    form: str = ""
    report: BakeReport | None = None
    error: str | None = None


@dataclass(frozen=True)
class _Answer:
    """A worker's answer; ``contents`` is the body file if the worker could not write it."""

    outcome: BakeOutcome
    contents: bytes | None = None


def always() -> bool:
    """Default of ``wanted``: results are always wanted."""
    return True


def bake_many(
    tasks: Iterable[BakeTask],
    folder: Path,
    executor: Executor,
    *,
    on_done: Callable[[BakeOutcome], None] = unwatched,
    on_wait: Callable[[int], None] = unwatched,
    at_once: int = 8,
    wanted: Callable[[], bool] = always,
    python: Sequence[str] | None = None,
) -> list[BakeOutcome]:
    """Bake all ``tasks`` by the workers of ``executor`` into ``folder``.

    Parameters
    ----------
    tasks : may be a generator; consumed only as workers become free.
    folder : of the body files; made if missing.
    executor : takes functions and picklable arguments. On one machine threads are as good as
        processes. Set ``settings.threads`` of the tasks so that the workers together have one
        thread a core.
    on_done : called in this thread with each outcome as it arrives, failures too.
    on_wait : called in this thread several times a second with the number of running tasks; an
        exception from it stops all bakes.
    at_once : submitted tasks at most, so that waiting tasks do not fill the memory.
    wanted : called by workers without access to ``folder``; a picklable function that turns false
        when the results are no longer wanted.
    python : command to start Python on workers; their own ``sys.executable`` if None.

    Returns
    -------
    Outcomes in order of completion. A failure does not stop the other bakes.

    Raises
    ------
    UnwritableError
        The folder cannot be made or written.
    """
    outcomes: list[BakeOutcome] = []

    def note(outcome: BakeOutcome) -> None:
        outcomes.append(outcome)
        on_done(outcome)

    waiting = iter(tasks)
    with _under_way() as running, lease(folder) as sign:
        while True:
            for task in _next_of(waiting, at_once - len(running)):
                try:
                    future = executor.submit(_bake, task, folder, sign, wanted, python)
                except Exception as problem:  # noqa: BLE001  reported with the mesh's name
                    note(_failed(task, problem))
                else:
                    running[future] = task
            if not running:
                return outcomes
            done, _ = wait(running, timeout=LOOK_UP_SECONDS, return_when=FIRST_COMPLETED)
            on_wait(len(running))
            for future in done:
                note(_outcome(running.pop(future), folder, future))


def _next_of(waiting: Iterator[BakeTask], count: int) -> Iterator[BakeTask]:
    for _ in range(count):
        task = next(waiting, None)
        if task is None:
            return
        yield task


@contextmanager
def _under_way() -> Iterator[dict[Future[_Answer], BakeTask]]:
    """Futures and their tasks; on an exception the rest is cancelled and awaited."""
    running: dict[Future[_Answer], BakeTask] = {}
    try:
        yield running
    finally:
        for future in running:
            future.cancel()
        wait(running, timeout=STOP_SECONDS)


def _outcome(task: BakeTask, folder: Path, future: Future[_Answer]) -> BakeOutcome:
    try:
        answer = future.result()
    except Exception as problem:  # noqa: BLE001  reported with the mesh's name
        return _failed(task, problem)
    if answer.contents is not None:
        try:
            with atomic_file(folder / task.file_name) as file:
                file.write(answer.contents)
        except UnwritableError as refusal:
            return BakeOutcome(task.name, error=str(refusal))
    return answer.outcome


def _failed(task: BakeTask, problem: BaseException) -> BakeOutcome:
    last_words = [type(problem).__name__, *str(problem).strip().splitlines()[-1:]]
    return BakeOutcome(
        task.name,
        error=f"the worker failed ({': '.join(last_words)}); bake this mesh alone to see whether "
        "it is the mesh or the worker",
    )


def _bake(
    task: BakeTask,
    folder: Path,
    sign: Lease,
    wanted: Callable[[], bool],
    python: Sequence[str] | None,
) -> _Answer:
    """Run a bake in the worker."""
    reaches_folder = sign.is_seen()
    stop = _stopping(sign.is_seen if reaches_folder else wanted)
    with ScratchFolder("worker") as scratch:
        target = (folder if reaches_folder else scratch.path) / task.file_name
        try:
            body, report = run_bake(
                task.source,
                task.settings,
                target,
                stop,
                task.surface,
                python or (sys.executable,),
            )
        except PalpateError as problem:
            return _Answer(BakeOutcome(task.name, error=str(problem)))
        outcome = BakeOutcome(
            task.name,
            folder / task.file_name,
            len(body.mesh.nodes),
            body.compliance.node_count,
            body.compliance.form,
            report,
        )
        return _Answer(outcome, None if reaches_folder else target.read_bytes())


def _stopping(wanted: Callable[[], bool]) -> Callable[[object], None]:
    """Progress callback that ends the bake once its result is no longer wanted."""
    next_look = 0.0

    def stop(_: object) -> None:
        nonlocal next_look
        if time.monotonic() < next_look:
            return
        next_look = time.monotonic() + LOOK_UP_SECONDS
        if not wanted():
            raise CancelledError("bake: stopped, since nobody waits for the result any more")

    return stop
