"""``palpate press``: press a body at a place and read the force."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np

from ..core import cache
from ..core.errors import PalpateError
from ..core.stiffness import lame_parameters
from ..core.whole_file import whole_file
from .body_figures import as_lines


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Describe the command."""
    parser = subparsers.add_parser("press", help="press a body once and read the force")
    parser.add_argument("body", type=Path, metavar="BODY.npz")
    for name, what in (
        ("at", "the surface point nearest to this is touched"),
        ("by", "the finger's displacement from there"),
    ):
        parser.add_argument(
            f"--{name}",
            type=float,
            nargs=3,
            required=True,
            metavar=("X", "Y", "Z"),
            help=f"{what} (metres, body coordinates)",
        )
    parser.add_argument("--young", type=float, metavar="PA", help="default: the body's own")
    parser.add_argument(
        "--mode",
        choices=["paper"],
        default="paper",
        help="contact inside triangles (default paper)",
    )
    parser.add_argument(
        "--displacements",
        type=Path,
        metavar="OUT.npy",
        help="write displacements of the free surface nodes, float64 (n, 3)",
    )
    parser.add_argument("--json", action="store_true", help="print figures as JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Touch, deform, print."""
    body = cache.load(arguments.body)
    young_modulus = body.young_modulus if arguments.young is None else arguments.young
    lame_parameters(young_modulus, body.poisson_ratio)
    touch = body.touch_nearest(arguments.at, arguments.by, young_modulus)
    displacements = body.deform(touch.triangle, touch.nodal_forces, young_modulus)
    if not (np.isfinite(touch.force).all() and np.isfinite(displacements).all()):
        raise PalpateError(
            f"--young: at {young_modulus} Pa this press is beyond what numbers can hold; give less"
        )
    if arguments.displacements is not None:
        with whole_file(arguments.displacements) as file:
            np.save(file, displacements)
    figures = {
        "triangle": touch.triangle.tolist(),
        "alpha": touch.alpha.tolist(),
        "point": touch.point.tolist(),
        "nodal_forces": touch.nodal_forces.tolist(),
        "force": touch.force.tolist(),
        "contact_displacement": body.contact_displacement(touch, displacements).tolist(),
        "max_displacement": float(np.linalg.norm(displacements, axis=1).max()),
        "young_modulus": young_modulus,
        "mode": arguments.mode,
    }
    print(json.dumps(figures) if arguments.json else as_lines(figures))
    return 0
