"""The part of ``palpate servo`` that lays the first body of a scene among the others."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...core.body.soft_body import SoftBody
from ...core.contact.tool.tools import Tool
from ...core.errors import PalpateError
from ...core.servo.session import Body, PropAmong, native_tool
from ..scene.scene_commands import refuse_options
from ..scene.scene_file import read_scene

if TYPE_CHECKING:
    # Types only, absent at run time.
    from ...core.contact.tool.pose import Pose
    from ...core.servo.session import Servo


@dataclass(frozen=True)
class LaidScene:
    """The first body of a scene at rest among the others: itself, native, where its frame is in the
    world, as the servo has it, and the tools that devices lead.
    """

    body: SoftBody
    native: Body
    placement: Pose
    prop: PropAmong
    tools: tuple[Tool, ...]

    def equip(self, servo: Servo) -> None:
        """Give each finger its tool."""
        for finger, tool in enumerate(self.tools):
            servo.set_tool(native_tool(self.body, self.native, tool), finger)


def laid_scene(arguments: argparse.Namespace, fingers: int) -> LaidScene:
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
    pile = scene.untouched()
    pile.laid()
    first = pile.settle()[0]
    tools = tuple(tool for tool, _ in scene.tools[:fingers])
    return LaidScene(first.body, pile.native_body, first.placement, pile.laid(), tools)
