"""``palpate bake``: from a mesh file to a body file."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..core.bake import BakeReport, BakeSettings
from ..core.bake_job import JobProgress, run_bake
from ..core.devices.stop_signals import stopped_by_signals
from ..core.errors import PalpateError
from ..core.pins import PinBelow, PinNodes, Pins
from ..core.read_mesh import read_surface, read_tets
from ..core.soft_body import SoftBody
from ..core.surface import Surface
from ..core.tet_mesh import TetMesh
from .body_figures import as_lines, body_figures

DEFAULT_PIN_FRACTION = 0.1
AXES = {"x": 0, "y": 1, "z": 2}


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Describe the command."""
    default = BakeSettings()
    parser = subparsers.add_parser("bake", help="make a body file from a mesh file")
    parser.add_argument("mesh", type=Path, metavar="MESH.(obj|ply|stl|npz)")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="BODY.npz")
    parser.add_argument(
        "--edge-length",
        type=float,
        metavar="F",
        help="wanted edge length of tetrahedra as a share of the bounding box diagonal "
        f"(default {default.edge_length:g}; not for npz)",
    )
    parser.add_argument(
        "--epsilon",
        type=float,
        default=default.epsilon,
        metavar="F",
        help="how far the body's surface may lie from the mesh's, as such a share "
        "(default %(default)g)",
    )
    parser.add_argument(
        "--pin-below",
        type=float,
        metavar="FRACTION",
        help="pin surface nodes within this lowest share of the height "
        f"(default: 'fixed' of an npz, else {DEFAULT_PIN_FRACTION:g})",
    )
    parser.add_argument("--up", choices=AXES, default="z", help="upward axis (default z)")
    parser.add_argument(
        "--young",
        type=float,
        default=default.young_modulus,
        metavar="PA",
        help="Young's modulus stored as the default for presses (default %(default)g)",
    )
    parser.add_argument(
        "--poisson",
        type=float,
        default=default.poisson_ratio,
        metavar="NU",
        help="Poisson's ratio (default %(default)g)",
    )
    parser.add_argument(
        "--metres-per-unit",
        type=float,
        default=1.0,
        metavar="S",
        help="unit of the file (default 1)",
    )
    parser.add_argument(
        "--time-limit",
        type=float,
        default=default.time_limit,
        metavar="S",
        help="give up tetrahedralization after so many seconds (default %(default)g)",
    )
    parser.add_argument("--json", action="store_true", help="print figures as JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Bake and print the body's figures. Whoever asks it to stop finds nothing left of it."""
    # From the first import on: readers of meshes swallow the exception that Ctrl-C is.
    with stopped_by_signals() as stopped:
        body, report = _bake(arguments, stopped)
    if sys.stderr.isatty():
        print("\r\x1b[K", end="", file=sys.stderr)
    for warning in report.warnings:
        print(f"palpate: warning: {warning}", file=sys.stderr)
    figures = {**body_figures(body), **report.as_dict(), "body": str(arguments.output)}
    print(json.dumps(figures) if arguments.json else as_lines(figures))
    return 0


def _bake(arguments: argparse.Namespace, stopped: Sequence[int]) -> tuple[SoftBody, BakeReport]:
    if not (np.isfinite(arguments.metres_per_unit) and arguments.metres_per_unit > 0):
        raise PalpateError(
            f"--metres-per-unit: {arguments.metres_per_unit} is not a positive number; "
            "give 0.001 for a file in millimetres"
        )
    folder = arguments.output.absolute().parent
    if not folder.exists():
        raise PalpateError(f"{arguments.output}: there is no folder {folder}; make it first")
    source, fixed = _source(arguments)
    settings = BakeSettings(
        poisson_ratio=arguments.poisson,
        young_modulus=arguments.young,
        pins=_pins(arguments, fixed),
        edge_length=(
            BakeSettings.edge_length if arguments.edge_length is None else arguments.edge_length
        ),
        epsilon=arguments.epsilon,
        time_limit=arguments.time_limit,
    )

    def watch(progress: JobProgress) -> None:
        if stopped:
            raise KeyboardInterrupt
        _show(progress)

    return run_bake(source, settings, arguments.output, watch)


def _source(
    arguments: argparse.Namespace,
) -> tuple[Surface | TetMesh, NDArray[np.int64] | None]:
    if arguments.mesh.suffix.lower() != ".npz":
        return read_surface(arguments.mesh, arguments.metres_per_unit), None
    if arguments.edge_length is not None:
        raise PalpateError(
            f"--edge-length: {arguments.mesh} holds tetrahedra already; leave the option out, or "
            "give a surface (obj, ply, stl)"
        )
    file = read_tets(arguments.mesh, arguments.metres_per_unit)
    return file.mesh, file.fixed


def _pins(arguments: argparse.Namespace, fixed: NDArray[np.int64] | None) -> Pins:
    if arguments.pin_below is not None:
        return PinBelow(arguments.pin_below, AXES[arguments.up])
    if fixed is not None:
        return PinNodes(fixed)
    return PinBelow(DEFAULT_PIN_FRACTION, AXES[arguments.up])


def _show(progress: JobProgress) -> None:
    if sys.stderr.isatty():
        share = "" if progress.share is None else f" {100 * progress.share:3.0f} %"
        line = f"{progress.text}{share}, {progress.seconds:.0f} s"
        print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)
