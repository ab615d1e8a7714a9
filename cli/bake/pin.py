"""``palpate pin``: more pins for a body, without a new bake."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core.bake.repin import pin_more
from ...core.body import body_file
from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.files.atomic_file import refuse_missing_folder
from ...core.files.npz_archive import ArchiveError, read_array
from ...core.files.ordinary_file import refuse_missing
from ...core.files.small_text import read_small_text
from ...core.stiffness.pins import PinBelow, pinned_nodes
from ..body.body_argument import add_body
from ..body.body_figures import body_figures
from ..body.figure_lines import as_lines
from .bake_options import AXES

HELP = "pin more of a body, without a new bake"
# A million node numbers.
MOST_TEXT_BYTES = 10_000_000
DESCRIPTION = "Write the body file that a bake with these nodes pinned besides would give."


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    add_body(parser)
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="OUT.npz", help="body file to write"
    )
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument(
        "--below",
        type=float,
        metavar="FRACTION",
        help="pin surface nodes within this lowest share of the height, besides those pinned",
    )
    which.add_argument(
        "--nodes",
        type=Path,
        metavar="FILE",
        help="pin these nodes besides: numbers in a text file, or an integer array in a .npy",
    )
    parser.add_argument("--up", choices=AXES, default="z", help="upward axis (default: z)")


def run(arguments: argparse.Namespace) -> int:
    """Load, pin, write, describe."""
    refuse_missing_folder(arguments.output)
    start = time.perf_counter()
    body = body_file.load(arguments.body)
    pinned = pin_more(body, _added(arguments, body))
    body_file.save(pinned, arguments.output)
    figures = {
        **body_figures(pinned),
        "pinned_before": len(body.fixed),
        "body": str(arguments.output),
        "seconds": {"pin": time.perf_counter() - start},
    }
    print(json.dumps(figures) if arguments.json else as_lines(figures))
    return 0


def _added(arguments: argparse.Namespace, body: SoftBody) -> NDArray[np.int64]:
    if arguments.nodes is not None:
        return _read_numbers(arguments.nodes)
    return pinned_nodes(PinBelow(arguments.below, AXES[arguments.up]), body.mesh, None)


def _read_numbers(file: Path) -> NDArray[np.int64]:
    """Node numbers, (k,).

    Raises
    ------
    PalpateError
        There is no such file, or it holds something else than whole numbers.
    """
    refuse_missing(file)
    try:
        if file.suffix.lower() == ".npy":
            numbers = read_array(file)
        else:
            words = read_small_text(file, MOST_TEXT_BYTES).split()
            numbers = np.array([int(word) for word in words])
    except ArchiveError as problem:
        raise PalpateError(f"{problem}; save node numbers with numpy.save") from problem
    except (ValueError, OverflowError) as problem:
        raise PalpateError(
            f"{file}: cannot be read as node numbers ({problem}); give whole numbers with blanks "
            "or lines between them"
        ) from problem
    if not numbers.size or not np.issubdtype(numbers.dtype, np.integer):
        raise PalpateError(f"{file}: holds no node numbers; give at least one whole number")
    return np.asarray(numbers, dtype=np.int64).ravel()
