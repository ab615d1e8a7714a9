"""``--floor`` and its kin: what a body without pins lies on."""

from __future__ import annotations

import argparse

from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.rest.rest_settings import EARTH
from ...core.rest.support import Floor

USUAL_FRICTION = Floor.friction


def add_floor(parser: argparse.ArgumentParser) -> None:
    """Add the options of the floor."""
    floor = parser.add_argument_group("floor, for a body without pins")
    floor.add_argument(
        "--floor",
        type=float,
        metavar="Z",
        help="its height (metres, body coordinates; default: the body's lowest point)",
    )
    floor.add_argument(
        "--floor-friction",
        type=float,
        metavar="MU",
        help=f"coefficient of friction between floor and body (default: {USUAL_FRICTION:g})",
    )
    floor.add_argument(
        "--gravity",
        type=float,
        metavar="G",
        help=f"downwards, m/s2 (default: {-EARTH[2]:g})",
    )


def floor_under(arguments: argparse.Namespace, body: SoftBody) -> Floor:
    """The floor that the options tell.

    Raises
    ------
    PalpateError
        A friction that is negative or no number.
    """
    lowest = float(body.mesh.nodes[:, 2].min())
    friction = arguments.floor_friction
    return Floor(
        lowest if arguments.floor is None else arguments.floor,
        USUAL_FRICTION if friction is None else friction,
    )


def gravity(arguments: argparse.Namespace) -> tuple[float, float, float]:
    """As the options tell, (3,), m/s2."""
    return EARTH if arguments.gravity is None else (0.0, 0.0, -arguments.gravity)


def refuse_floor_of_pinned(arguments: argparse.Namespace) -> None:
    """Refuse a floor under a body that is pinned.

    Raises
    ------
    PalpateError
        Names the option.
    """
    for option in ("floor", "floor_friction", "gravity"):
        if getattr(arguments, option) is not None:
            raise PalpateError(
                f"--{option.replace('_', '-')}: the body is pinned and lies on nothing; bake it "
                "with --pins none, or leave the option out"
            )
