"""``palpate curve``: force against depth at a place of a body."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from ...core.body import body_file
from ...core.body.soft_body import SoftBody
from ...core.files.atomic_file import atomic_file, refuse_missing_folder
from ...core.softness.curve_picture import curve_svg
from ...core.softness.force_depth import MILLIMETRES, ForceDepthCurve, force_depth_curve
from ..body.body_argument import add_body
from ..body.tool_option import KINDS, tool_from
from .place_options import add_at, add_young, positive_length, refuse_suffix, young_modulus_of

POINT, FINGERTIP = "point", "sphere:0.008"


HELP = "print force against depth at a place of a body"
DESCRIPTION = (
    "Press a point or tool into a body in steps, along the surface's normal, and "
    "print force and stiffness."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    add_body(parser)
    add_at(parser)
    parser.add_argument(
        "--tool",
        default=FINGERTIP,
        metavar="TOOL",
        help=f"what presses: {POINT}, {KINDS}, in metres (default: %(default)s, a fingertip)",
    )
    parser.add_argument(
        "--depth", type=positive_length, metavar="M", help="how far (default: what is small there)"
    )
    parser.add_argument(
        "--steps",
        type=int,
        default=20,
        metavar="N",
        help="steps to that depth (default: %(default)d)",
    )
    add_young(parser)
    parser.add_argument("--csv", type=Path, metavar="OUT.csv", help="write the curve as a table")
    parser.add_argument("--picture", type=Path, metavar="OUT.svg", help="write it as a picture")


def run(arguments: argparse.Namespace) -> int:
    """Compute the curve, print and write it."""
    for option, path, suffix in (
        ("--csv", arguments.csv, ".csv"),
        ("--picture", arguments.picture, ".svg"),
    ):
        if path is not None:
            refuse_suffix(option, path.name, path.suffix, (suffix,))
            refuse_missing_folder(path)
    body = body_file.load(arguments.body)
    curve = _curve(arguments, body)
    if arguments.csv is not None:
        with atomic_file(arguments.csv) as file:
            file.write(curve.as_csv().encode())
    if arguments.picture is not None:
        with atomic_file(arguments.picture) as file:
            file.write(curve_svg(curve).encode())
    if arguments.json:
        figures = {
            "tool": curve.tool,
            "place": curve.place.position.tolist(),
            "axis": curve.place.axis.tolist(),
            "depth_m": curve.depths.tolist(),
            "force_n": curve.forces.tolist(),
            "stiffness_n_per_m": curve.stiffness.tolist(),
            "contact_area_m2": curve.areas.tolist(),
        }
        print(json.dumps(figures))
    else:
        print(curve.as_csv(), end="")
        print(
            f"{curve.tool}: {curve.secant / MILLIMETRES:.3g} N/mm over "
            f"{curve.depths[-1] * MILLIMETRES:.3g} mm"
        )
    return 0


def _curve(arguments: argparse.Namespace, body: SoftBody) -> ForceDepthCurve:
    return force_depth_curve(
        body,
        arguments.at,
        arguments.depth,
        tool=None if arguments.tool == POINT else tool_from(arguments.tool),
        steps=arguments.steps,
        young_modulus=young_modulus_of(arguments, body),
    )
