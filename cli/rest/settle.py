"""``palpate settle``: lay a body without pins on a floor until it rests."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np

from ...core.body import body_file
from ...core.files.atomic_file import atomic_file
from ...core.rest.rest_settings import RestSettings
from ...core.rest.resting import Resting
from ...core.shape.firm_rest import settle_firmly
from ...core.shape.shapes import shape
from ..body.body_argument import add_body, add_young, modulus_of
from ..body.figure_lines import as_lines
from ..scene.scene_commands import settle_scene
from ..scene.scene_file import is_scene
from .floor_options import add_floor, floor_under, gravity
from .rest_figures import rest_figures

HELP = "lay bodies without pins on what bears them until they rest"
DESCRIPTION = (
    "Let a body that was baked without pins sink, slide and tip until it rests, and print where it "
    "lies and what the floor bears; or all bodies of a scene file, and what bears what."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the command's options."""
    add_body(parser, or_scene=True)
    add_floor(parser)
    add_young(parser)
    parser.add_argument(
        "--surface",
        type=Path,
        metavar="OUT",
        help="write the surface nodes where they come to lie, float64 (n, 3), as .npy; of a scene "
        "an .npz with those of each body under its name",
    )


def run(arguments: argparse.Namespace) -> int:
    """Load, settle, print."""
    if is_scene(arguments.body):
        return settle_scene(arguments)
    body = body_file.load(arguments.body)
    modulus = modulus_of(arguments, body)
    settings = RestSettings(modulus, gravity=gravity(arguments))
    lying = Resting(body, [floor_under(arguments, body)], settings=settings)
    (rest,) = settle_firmly(lying, [shape(body, "real")])
    if arguments.surface is not None:
        with atomic_file(arguments.surface) as file:
            np.save(file, rest.surface())
    figures = rest_figures(rest, modulus)
    print(json.dumps(figures) if arguments.json else as_lines(figures))
    return 0
