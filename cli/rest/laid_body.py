"""The part of ``palpate servo`` that lays a body without pins on a floor."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

from ...core.body.native_body import native_body
from ...core.body.soft_body import SoftBody
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.rest.prop import WORLD, native_prop
from ...core.rest.rest_settings import RestSettings
from ...core.rest.resting import Resting
from ...core.servo.session import Body, Prop, PropAmong, Servo, native_tool
from .floor_options import floor_under, gravity, refuse_floor_of_pinned


@dataclass(frozen=True)
class LaidBody:
    """A body for the servo: native, where its frame is in the world, as one that nobody holds or
    that lies among others, and the tools that devices lead; without any, fingers are points.

    A pinned one has no prop, and its frame is that of the world.
    """

    body: SoftBody
    native: Body
    placement: Pose
    prop: Prop | PropAmong | None
    tools: tuple[Tool, ...] = ()

    def equip(self, servo: Servo) -> None:
        """Give each finger its tool."""
        for finger, tool in enumerate(self.tools):
            servo.set_tool(native_tool(self.body, self.native, tool), finger)


def laid_body(
    arguments: argparse.Namespace, body: SoftBody, young_modulus: float, *, whole: bool
) -> LaidBody:
    """The body as the options lay it: one without pins at rest on its floor.

    Raises
    ------
    PalpateError
        A floor under a pinned body; a body that does not come to rest.
    """
    if not body.is_free:
        refuse_floor_of_pinned(arguments)
        return LaidBody(body, native_body(body, whole=whole), WORLD, None)
    floor = floor_under(arguments, body)
    settings = RestSettings(young_modulus, gravity=gravity(arguments))
    placement = Resting(body, [floor], settings=settings).settle().placement
    native = native_body(body, whole=True, may_move=True)
    prop = native_prop(body, native, [floor], placement, settings)
    return LaidBody(body, native, placement, prop)
