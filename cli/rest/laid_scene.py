"""The part of ``palpate servo`` that lays the first body of a scene among the others."""

from __future__ import annotations

import argparse

from ...core.errors import PalpateError
from ..scene.scene_commands import refuse_options
from ..scene.scene_file import read_scene
from .laid_body import LaidBody


def laid_scene(arguments: argparse.Namespace, fingers: int) -> LaidBody:
    """The scene of a file at rest, for so many fingers, which lead its tools in their order.

    Raises
    ------
    PalpateError
        Options about one body, fewer tools than fingers, bodies that do not come to rest, more of
        them than a servo takes, a first one that is pinned.
    """
    refuse_options(arguments)
    scene = read_scene(arguments.body)
    if len(scene.tools) < fingers:
        raise PalpateError(
            f"{arguments.body}: it has {len(scene.tools)} tools for {fingers} devices; bodies that "
            "press each other are pressed by tools, so give each device one in 'tools'"
        )
    tools = tuple(tool for tool, _ in scene.tools[:fingers])
    pile = scene.untouched(tools)
    # What a servo does not take is refused before all comes to rest, which may take long.
    pile.laid()
    first = pile.settle()[0]
    return LaidBody(first.body, pile.native_body, first.placement, pile.laid(), tools)
