"""``palpate bake``: mesh files to body files, or a prediction of the cost."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from ...core.bake.job import JobProgress, run_bake
from ...core.bake.steps import BakeReport
from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.files.atomic_file import refuse_missing_folder
from ...core.machine.stop_signals import stopped_by_signals
from ..body.body_figures import body_figures
from ..body.figure_lines import as_lines
from . import bake_folder, bake_prediction
from .bake_options import add_bake_options, bake_input
from .forecast import foretell
from .status_line import bake_status, status_line

HELP = "make body files from mesh files"
DESCRIPTION = (
    "Fill meshes with tetrahedra and compute once how their surfaces give way: "
    "one body file for each mesh."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    parser.add_argument(
        "meshes",
        type=Path,
        nargs="+",
        metavar="MESH.(obj|ply|stl|npz)",
        help="closed or nearly closed surfaces, or tetrahedra (npz)",
    )
    result = parser.add_mutually_exclusive_group(required=True)
    result.add_argument(
        "-o", "--output", type=Path, metavar="BODY.npz", help="body file of one mesh"
    )
    result.add_argument(
        "--output-folder",
        type=Path,
        metavar="FOLDER",
        help="folder for many meshes: each becomes FOLDER/NAME.npz",
    )
    result.add_argument(
        "--predict",
        action="store_true",
        help="print predicted nodes, time, memory and file size, and bake nothing",
    )
    workers = parser.add_argument_group("many meshes").add_mutually_exclusive_group()
    workers.add_argument(
        "--jobs",
        type=int,
        metavar="N",
        help="bakes at once on this computer (default: its cores)",
    )
    workers.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="bake on a Dask cluster, for example tcp://farm:8786, or its scheduler file",
    )
    add_bake_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Bake and print figures; nothing unfinished is left when stopped."""
    if arguments.predict:
        _refuse_options_for_many(arguments)
        return bake_prediction.run(arguments)
    # From the first import on: mesh readers swallow KeyboardInterrupt.
    with stopped_by_signals() as stopped:
        try:
            if arguments.output_folder is not None:
                return bake_folder.run(arguments, stopped)
            body, report = _bake(arguments, stopped)
        except PalpateError:
            if stopped:
                # Ctrl-C in a terminal stops the child too, which then looks like a failure.
                raise KeyboardInterrupt from None
            raise
    for warning in report.warnings:
        print(f"palpate: warning: {warning}", file=sys.stderr)
    figures = {**body_figures(body), **report.as_dict(), "body": str(arguments.output)}
    print(json.dumps(figures) if arguments.json else as_lines(figures))
    return 0


def _refuse_options_for_many(arguments: argparse.Namespace) -> None:
    for option in ("jobs", "scheduler"):
        if getattr(arguments, option) is not None:
            raise PalpateError(
                f"--{option}: is for baking many meshes into an --output-folder; name one instead "
                "of -o or --predict, or leave the option out"
            )


def _bake(arguments: argparse.Namespace, stopped: Sequence[int]) -> tuple[SoftBody, BakeReport]:
    if len(arguments.meshes) > 1:
        raise PalpateError(
            f"-o: {len(arguments.meshes)} meshes do not fit in one body file; name a folder with "
            "--output-folder"
        )
    _refuse_options_for_many(arguments)
    refuse_missing_folder(arguments.output)
    given = bake_input(arguments, arguments.meshes[0], arguments.threads)
    foretell(arguments.meshes[0], given)

    def watch(progress: JobProgress) -> None:
        if stopped:
            raise KeyboardInterrupt
        line.show(bake_status(progress))

    with status_line() as line:
        return run_bake(given.source, given.settings, arguments.output, watch)
