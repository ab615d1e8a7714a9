"""What ``palpate settle`` and ``palpate press`` do with a scene file."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...core.contact.place import Place, nearest_place
from ...core.contact.single_press import pairs_checked, set_down
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.errors import PalpateError
from ...core.pile.pile import Pile
from ...core.rest.bearing_points import pressing_points
from ...core.rest.rest import Rest
from ...core.shape.firm_rest import settle_firmly
from ...core.shape.shapes import Shape, shape
from ..body.shape_option import shape_of
from ..body.tool_option import tool_from
from .scene_figures import Told, for_people, scene_figures, write_surfaces
from .scene_file import Led, Scene, read_scene

# Of the servo; no other is for bodies without pins.
USUAL_MODE = "consistent"
# Told by the scene, or about one body alone.
ONE_BODY = ("floor", "floor_friction", "gravity", "young", "friction", "mode")


def settle_scene(arguments: argparse.Namespace) -> int:
    """Read, let all come to rest, print."""
    refuse_options(arguments)
    scene = read_scene(arguments.body)
    pile = scene.pile()
    rests = settle_firmly(pile, _shapes(pile, "real"))
    if arguments.surface is not None:
        write_surfaces(arguments.surface, scene, rests, Rest.surface)
    _print(arguments, scene_figures(scene, rests, scene.tool_names))
    return 0


def press_scene(arguments: argparse.Namespace) -> int:
    """Read, let all come to rest, move the scene's tools and those that are set down, print."""
    refuse_options(arguments)
    if arguments.shape == "paper":
        raise PalpateError(
            "--shape: the paper's tables are of a body alone; give real or linear for a scene"
        )
    scene = read_scene(arguments.body)
    rests, names = _pressed(arguments, scene)
    if arguments.displacements is not None:
        write_surfaces(arguments.displacements, scene, rests, Rest.displacements)
    _print(arguments, scene_figures(scene, rests, names))
    return 0


def _pressed(
    arguments: argparse.Namespace, scene: Scene
) -> tuple[tuple[Rest, ...], tuple[str, ...]]:
    """All at rest under the tools where these have gone, and the tools' names."""
    pile = scene.pile()
    shapes = _shapes(pile, shape_of(arguments))
    rests = settle_firmly(pile, shapes)
    if arguments.tool is None and not arguments.at and not arguments.by:
        if not scene.tools:
            raise PalpateError(
                f"{arguments.body}: it has no tools that press; give --tool, --at and --by, or "
                "'tools' in the file"
            )
        pile.lead(_moved(scene.tools, scene.ways))
        return settle_firmly(pile, shapes), scene.tool_names
    if arguments.tool is None:
        raise PalpateError("--tool: bodies of a scene are pressed by tools only; give one")
    places, ways = pairs_checked(arguments.at or [], arguments.by or [])
    tool = tool_from(arguments.tool)
    more = [(tool, _set_down(rests, tool, place)) for place in places]
    pile = scene.pile([rest.placement for rest in rests], more)
    pile.settle()
    pile.lead(_moved([*scene.tools, *more], [*scene.ways, *ways]))
    names = [f"--tool {number}" for number in range(1, len(more) + 1)]
    return settle_firmly(pile, shapes), (*scene.tool_names, *names)


def _shapes(pile: Pile, name: str) -> list[Shape]:
    """The shape of this name of each body; equal bodies share one."""
    made = {body: shape(body, name) for body in pile.bodies}
    return [made[body] for body in pile.bodies]


def _moved(
    tools: Sequence[Led], ways: Sequence[NDArray[np.float64] | Sequence[float]]
) -> list[Pose]:
    return [pose.moved(np.asarray(way)) for (_, pose), way in zip(tools, ways, strict=True)]


def _set_down(rests: Sequence[Rest], tool: Tool, at: NDArray[np.float64]) -> Pose:
    """Pose in the world of a tool on the body nearest to a place, where that lies."""
    laid = [(rest, (at - rest.placement.position) @ rest.placement.rotation) for rest in rests]
    found = [(rest, own, nearest_place(rest.body, own)) for rest, own in laid]
    rest, _, place = min(found, key=_gap)
    points, _ = pressing_points(rest.body, tool)
    pose = set_down(rest.body, tool, place, points=points)
    return Pose(rest.to_world(pose.position), rest.placement.rotation @ pose.rotation)


def _gap(found: tuple[Rest, NDArray[np.float64], Place]) -> float:
    _, at, place = found
    return float(np.linalg.norm(place.position - at))


def refuse_options(arguments: argparse.Namespace) -> None:
    """Nothing may be asked for that a scene tells itself.

    Raises
    ------
    PalpateError
        An option about one body.
    """
    for option in ONE_BODY:
        if getattr(arguments, option, None) not in (None, USUAL_MODE):
            raise PalpateError(
                f"--{option.replace('_', '-')}: it is about one body; a scene file tells this "
                "itself, so leave the option out"
            )


def _print(arguments: argparse.Namespace, figures: Told) -> None:
    print(json.dumps(figures) if arguments.json else for_people(figures))
