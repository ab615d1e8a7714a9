"""``palpate softness``: map of a body's softness over its surface."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np

from ...core.body import body_file
from ...core.files.atomic_file import atomic_file, refuse_missing_folder
from ...core.softness.coloured_ply import write_ply
from ...core.softness.force_depth import MILLIMETRES
from ...core.softness.ramp import legend
from ...core.softness.softness_map import FINGER_RADIUS, softness_map
from ..body.body_argument import add_body
from ..body.figure_lines import as_lines
from .place_options import add_young, refuse_suffix, young_modulus_of

KINDS = (".npy", ".ply")


HELP = "map how soft a body is all over its surface"
DESCRIPTION = "Write how firm a body is under a finger at each node of its surface."


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    add_body(parser)
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="OUT.(npy|ply)",
        help="npy: N/m for each surface node, float64 (s,); ply: the surface with colours",
    )
    parser.add_argument(
        "--pad",
        type=float,
        default=FINGER_RADIUS,
        metavar="M",
        help="radius of the round pad that presses (default: %(default)g); 0 for the bare node, "
        "which follows the mesh",
    )
    add_young(parser)


def run(arguments: argparse.Namespace) -> int:
    """Compute the map, write it, and print the legend."""
    refuse_suffix("--output", arguments.output.name, arguments.output.suffix, KINDS)
    refuse_missing_folder(arguments.output)
    body = body_file.load(arguments.body)
    found = softness_map(
        body, pad_radius=arguments.pad, young_modulus=young_modulus_of(arguments, body)
    )
    with atomic_file(arguments.output) as file:
        if arguments.output.suffix.lower() == ".npy":
            np.save(file, found.stiffness)
        else:
            write_ply(file, body, found)
    low, high = found.span
    figures = {
        "surface_nodes": len(found.stiffness),
        "softest_n_per_mm": float(found.stiffness.min()) / MILLIMETRES,
        "firmest_n_per_mm": float(found.stiffness.max()) / MILLIMETRES,
        "colours_n_per_mm": [float(f"{value / MILLIMETRES:.4g}") for value, _ in legend(low, high)],
        "output": str(arguments.output),
    }
    print(json.dumps(figures) if arguments.json else as_lines(figures))
    return 0
