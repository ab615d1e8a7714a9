"""The part of ``palpate press`` that presses a body which lies on a floor."""

from __future__ import annotations

import argparse

import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.place import nearest_place
from ...core.contact.single_press import pairs_checked, set_down
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.errors import PalpateError
from ...core.rest.bearing_points import pressing_points
from ...core.rest.rest import Rest
from ...core.rest.rest_settings import RestSettings
from ...core.rest.resting import Resting
from ...core.shape.firm_rest import settle_firmly
from ...core.shape.shapes import shape
from ..body.shape_option import shape_of
from .floor_options import floor_under, gravity, refuse_floor_of_pinned


def refuse_floor(arguments: argparse.Namespace, body: SoftBody) -> None:
    """Refuse a point on a body without pins, and a floor under one that is pinned.

    Raises
    ------
    PalpateError
        Names the option.
    """
    if body.is_free:
        raise PalpateError(
            "--tool: a body without pins is pressed by tools only, as it lies on its floor; give "
            "one, such as sphere:0.008, or pin the body ('palpate pin')"
        )
    refuse_floor_of_pinned(arguments)


def refuse_beside_floor(arguments: argparse.Namespace) -> None:
    """Refuse what a body on its floor cannot be pressed with.

    Raises
    ------
    PalpateError
        Names the option.
    """
    if arguments.mode is not None:
        raise PalpateError("--mode: it is about points; leave it out with --tool")
    if arguments.shape == "paper":
        raise PalpateError(
            "--shape: the paper's tables are of bodies with pins; give real or linear, or pin the "
            "body ('palpate pin')"
        )


def pressed_on_floor(
    arguments: argparse.Namespace, body: SoftBody, tool: Tool, young_modulus: float
) -> Rest:
    """Let the body settle on its floor, set tools of one kind down on it and move them.

    ``--at`` is where the surface lies then. The tools move without turning, and the body rests
    again at the end.

    Raises
    ------
    PalpateError
        Coordinates that are not three finite numbers; a body that does not come to rest.
    """
    places, ways = pairs_checked(arguments.at, arguments.by)
    floor = floor_under(arguments, body)
    settings = RestSettings(young_modulus, arguments.friction or 0.0, gravity(arguments))
    shapes = [shape(body, shape_of(arguments))]
    (alone,) = settle_firmly(Resting(body, [floor], settings=settings), shapes)
    starts = [_set_down(alone, tool, place) for place in places]
    resting = Resting(
        body,
        [floor],
        [(tool, start) for start in starts],
        placement=alone.placement,
        settings=settings,
    )
    resting.settle()
    pairs = zip(starts, ways, strict=True)
    resting.lead([start.moved(way) for start, way in pairs])
    (rest,) = settle_firmly(resting, shapes)
    return rest


def _set_down(alone: Rest, tool: Tool, place: NDArray[np.float64]) -> Pose:
    """Pose in the world of a tool on the body's surface at rest, nearest to a place there."""
    turn = alone.placement.rotation
    own = (place - alone.placement.position) @ turn
    points, _ = pressing_points(alone.body, tool)
    laid = set_down(alone.body, tool, nearest_place(alone.body, own), points=points)
    return Pose(alone.to_world(laid.position), turn @ laid.rotation)
