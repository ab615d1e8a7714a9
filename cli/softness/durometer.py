"""``palpate durometer``: set a virtual durometer on a body and read it."""

from __future__ import annotations

import argparse
import json
import sys

from ...core.body import body_file
from ...core.softness.durometer import read_durometer
from ...core.softness.scales.durometer_type import TYPES
from ..body.body_argument import add_body
from ..body.figure_lines import as_lines
from .place_options import add_at, add_young, young_modulus_of

HELP = "read a virtual durometer set on a body"
DESCRIPTION = (
    "Press the standard's indenter into a body and print the Shore value that the "
    "instrument would show there."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    add_body(parser)
    add_at(parser)
    parser.add_argument(
        "--scale", choices=TYPES, default="00", help="Shore scale (default: %(default)s)"
    )
    add_young(parser)
    pressed = parser.add_mutually_exclusive_group()
    pressed.add_argument(
        "--load",
        type=float,
        metavar="N",
        help="force on the whole device (default: its foot just touches)",
    )
    pressed.add_argument(
        "--stand",
        action="store_true",
        help="press with the standard's mass: 400 g for 00, 1 kg for A",
    )


def run(arguments: argparse.Namespace) -> int:
    """Read and print; doubts about the reading go to standard error."""
    body = body_file.load(arguments.body)
    modulus = young_modulus_of(arguments, body)
    load = TYPES[arguments.scale].load if arguments.stand else arguments.load
    reading = read_durometer(body, arguments.at, arguments.scale, young_modulus=modulus, load=load)
    figures = {
        "shore": str(reading.shore),
        "value": reading.shore.value,
        "on_a_thick_block": reading.block.value,
        "place": reading.place.position.tolist(),
        "axis": reading.place.axis.tolist(),
        "indenter_depth_m": reading.depth,
        "indenter_force_n": reading.tip_force,
        "foot_depth_m": reading.foot_depth,
        "foot_force_n": reading.foot_force,
        "thickness_m": reading.thickness,
        "young_modulus": modulus,
        "warnings": list(reading.warnings),
    }
    for warning in reading.warnings:
        print(f"palpate: warning: {warning}", file=sys.stderr)
    if arguments.json:
        print(json.dumps(figures))
    else:
        print(as_lines({name: value for name, value in figures.items() if name != "warnings"}))
    return 0
