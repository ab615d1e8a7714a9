"""``palpate bake --output-folder``: many meshes, on local cores or on a cluster."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

from ...core.bake.many import BakeOutcome, BakeTask, bake_many
from ...core.errors import PalpateError
from ...core.machine.available_cores import available_cores
from .bake_options import bake_input
from .forecast import foretell
from .scheduler import Workers, cluster
from .status_line import duration, status_line

EXIT_ERROR = 2


def run(arguments: argparse.Namespace, stopped: Sequence[int]) -> int:
    """Bake all meshes; 0 if all succeeded, 2 if some failed, each with its reason."""
    names = _file_names(arguments.meshes, arguments.output_folder)
    outcomes: list[BakeOutcome] = []
    started = time.monotonic()

    def note(outcome: BakeOutcome) -> None:
        outcomes.append(outcome)
        line.clear()
        _print_outcome(outcome, as_json=arguments.json)

    def watch(running: int) -> None:
        if stopped:
            raise KeyboardInterrupt
        line.show(
            f"{len(outcomes)} of {len(names)} done, {running} under way, "
            f"{duration(time.monotonic() - started)}"
        )

    with _workers(arguments, len(names)) as workers, status_line() as line:
        threads = workers.threads if arguments.threads is None else arguments.threads
        bake_many(
            _tasks(arguments, names, threads, note),
            arguments.output_folder,
            workers.executor,
            on_done=note,
            on_wait=watch,
            # Twice as many as workers, so that none waits for a mesh to be read.
            at_once=2 * workers.count,
            wanted=workers.wanted,
        )
    if arguments.json:
        print(json.dumps({"bodies": [_figures(outcome) for outcome in outcomes]}))
    return EXIT_ERROR if any(outcome.error for outcome in outcomes) else 0


def _file_names(meshes: Sequence[Path], folder: Path) -> dict[Path, str]:
    """Body file names of the meshes, checked to be distinct."""
    if folder.exists() and not folder.is_dir():
        raise PalpateError(f"--output-folder: {folder} is a file; name a folder, existing or new")
    names: dict[Path, str] = {}
    makers: dict[str, Path] = {}
    for mesh in meshes:
        name = f"{mesh.stem}.npz"
        if name in makers:
            raise PalpateError(
                f"{mesh}: its body would be {folder / name}, and so would that of "
                f"{makers[name]}; rename one, or bake them into two folders"
            )
        if (folder / name).exists() and mesh.exists() and (folder / name).samefile(mesh):
            raise PalpateError(
                f"{mesh}: its body would take its place; choose another --output-folder"
            )
        names[mesh], makers[name] = name, mesh
    return names


@contextmanager
def _workers(arguments: argparse.Namespace, meshes: int) -> Iterator[Workers]:
    if arguments.scheduler is not None:
        with cluster(arguments.scheduler) as workers:
            yield workers
        return
    cores = available_cores()
    jobs = min(cores if arguments.jobs is None else arguments.jobs, meshes)
    if jobs < 1:
        raise PalpateError(f"--jobs: {arguments.jobs} bakes do nothing; give 1 or more")
    with ThreadPoolExecutor(jobs) as executor:
        yield Workers(executor, jobs, max(1, cores // jobs))


def _tasks(
    arguments: argparse.Namespace,
    names: dict[Path, str],
    threads: int,
    note: Callable[[BakeOutcome], None],
) -> Iterator[BakeTask]:
    """Tasks, their meshes read on demand; unreadable ones are noted."""
    for mesh, file_name in names.items():
        try:
            given = bake_input(arguments, mesh, threads)
            if arguments.scheduler is None:
                foretell(mesh, given)
        except PalpateError as problem:
            note(BakeOutcome(str(mesh), error=str(problem).removeprefix(f"{mesh}: ")))
        else:
            yield BakeTask(str(mesh), file_name, given.source, given.settings)


def _print_outcome(outcome: BakeOutcome, *, as_json: bool) -> None:
    if outcome.error is not None or outcome.report is None:
        print(f"palpate: {outcome.name}: {outcome.error}", file=sys.stderr)
        return
    for warning in outcome.report.warnings:
        print(f"palpate: warning: {outcome.name}: {warning}", file=sys.stderr)
    if not as_json:
        seconds = sum(outcome.report.seconds.values())
        print(
            f"{outcome.name} -> {outcome.path}  {outcome.nodes} nodes, "
            f"{outcome.free_surface_nodes} free on the surface, {outcome.form}, "
            f"{duration(seconds)}",
            flush=True,
        )


def _figures(outcome: BakeOutcome) -> dict[str, object]:
    if outcome.report is None:
        return {"mesh": outcome.name, "error": outcome.error}
    return {
        "mesh": outcome.name,
        "body": str(outcome.path),
        "nodes": outcome.nodes,
        "free_surface_nodes": outcome.free_surface_nodes,
        "form": outcome.form,
        **outcome.report.as_dict(),
    }
