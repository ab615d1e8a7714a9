"""A free body under its weight, on supports, pressed by tools: step by step, or until it rests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from palpate_servo import MAX_FINGERS, MOST_SUPPORTS
from palpate_servo import Resting as NativeResting
from palpate_servo import Tool as NativeTool

from ..body.native_body import native_body
from ..body.soft_body import SoftBody
from ..contact.near_field.compliance_beneath import near_correction
from ..contact.near_field.contact_points import contact_points
from ..contact.near_field.surface_shape import surface_area
from ..contact.press import tool_touch
from ..contact.tool.native_tool import native_shape, native_surface, native_tool
from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool
from ..contact.touches import ToolTouch
from ..errors import PalpateError
from .rest import BodyTouch, Rest
from .support import Floor, Support, friction_checked

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import Body, LaidTool, SettledTool, ToolSurface

EARTH = (0.0, 0.0, -9.81)
# Contact points for supports lie apart by this share of the root of the body's surface: a flat side
# of a cube has some fifty.
SUPPORT_SPACING = 1.0 / 14.0
# Displacements on a floor are found to some millionths of so many times how far a body sags, or of
# this share of its size.
REACH_PER_SAG = 30.0
LEAST_REACH = 1e-4


@dataclass(frozen=True)
class RestSettings:
    """Settings of a free body.

    Attributes
    ----------
    young_modulus : pascal; None for the body's own.
    friction : Coulomb's coefficient between tools and body; supports have their own.
    gravity : m/s2, in the world.
    drag_time : seconds; under a force the body goes by force over mass times this, metres a second.
        Where it comes to rest does not depend on it, without friction.
    spacing : metres between contact points for supports; None for the usual.
    """

    young_modulus: float | None = None
    friction: float = 0.5
    gravity: tuple[float, float, float] = EARTH
    drag_time: float = 0.05
    spacing: float | None = None


USUAL_REST = RestSettings()


class Resting:
    """A free body with supports and tools, which keeps what it holds from call to call.

    >>> from palpate.core.bake.settings import BakeSettings
    >>> from palpate.core.bake.steps import bake
    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> from palpate.core.stiffness.pins import NoPins
    >>> settings = BakeSettings(poisson_ratio=0.3, young_modulus=1e5, pins=NoPins(), density=1000.0)
    >>> cube, _ = bake(paper_cube()[0], settings)
    >>> rest = Resting(cube, [Floor()]).settle()
    >>> round(float(rest.supports[0].force[2]), 3)  # on the floor: its weight
    -1.226

    Parameters
    ----------
    body : free, with a density.
    supports : what it may rest on.
    tools : what may press it, with their poses in the world, outside of it.
    placement : of the body's frame in the world; None for that of the world.

    Raises
    ------
    PalpateError
        A body with pins or without a density, too many tools or supports, invalid settings.
    """

    def __init__(
        self,
        body: SoftBody,
        supports: Sequence[Floor | Support],
        tools: Sequence[tuple[Tool, Pose]] = (),
        *,
        placement: Pose | None = None,
        settings: RestSettings = USUAL_REST,
    ) -> None:
        if not body.is_free:
            raise PalpateError(
                "the body is pinned and cannot rest on anything; bake it without pins"
            )
        if len(tools) > MAX_FINGERS or len(supports) > MOST_SUPPORTS:
            raise PalpateError(
                "{tools} tools and {supports} supports touch the body; at most {most_tools} and "
                "{most_supports} may",
                tools=len(tools),
                supports=len(supports),
                most_tools=MAX_FINGERS,
                most_supports=MOST_SUPPORTS,
            )
        friction_checked(settings.friction)
        reach = _floor_reach(body, settings)
        self.body = body
        self.young_modulus = body.modulus(settings.young_modulus)
        native = native_body(body, whole=True, may_move=True)
        surface = _surface(body, native, settings.spacing)
        try:
            self._native = NativeResting(
                native,
                mass=body.mass,
                centre=body.inertia.centre,
                inertia=body.mass / body.inertia.volume * body.inertia.moments,
                young_modulus=self.young_modulus,
                drag_time=settings.drag_time,
                gravity=settings.gravity,
                tools=[
                    (*native_tool(body, native, tool), *_at(pose), settings.friction)
                    for tool, pose in tools
                ],
                supports=[_laid(surface, support, reach) for support in supports],
            )
        except ValueError as problem:
            raise PalpateError("rest: {problem}", problem=problem) from problem
        self._tools = tuple(tool for tool, _ in tools)
        if placement is not None:
            self.place(placement)

    def place(self, placement: Pose) -> None:
        """Lay the body elsewhere; its contacts are found anew."""
        self._native.place(*_at(placement))

    def come_in(self) -> None:
        """What overlaps the body comes in from outside, while the body stays where it is: so one
        that rested elsewhere goes on from there.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        try:
            self._native.come_in()
        except RuntimeError as problem:
            raise PalpateError("rest: {problem}", problem=problem) from problem

    def move_support(self, number: int, pose: Pose) -> None:
        """Have a support be elsewhere from the next step on."""
        self._native.lead_support(number, *_at(pose))

    def lead(self, goals: Sequence[Pose]) -> None:
        """Have the tools go to their goals, one each, from the next step on."""
        if len(goals) != len(self._tools):
            raise PalpateError(
                "{goals} goals for {tools} tools; give one for each",
                goals=len(goals),
                tools=len(self._tools),
            )
        for number, goal in enumerate(goals):
            self._native.lead_tool(number, *_at(goal))

    def step(self, seconds: float = 1e-3) -> Rest:
        """Go on by a tick, in which each tool goes by a stride at most.

        Raises
        ------
        PalpateError
            A force is no number; a tool or support that was set down within the body.
        """
        self.tick(seconds)
        return self._felt()

    def tick(self, seconds: float = 1e-3, *, hurried: bool = False) -> None:
        """Go on by a tick; hurried by as much work as the servo's may take at most, the rest of
        which is left to the next.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        try:
            self._native.tick(seconds, hurried=hurried)
        except (ValueError, RuntimeError) as problem:
            raise PalpateError("rest: {problem}", problem=problem) from problem

    def settle(self) -> Rest:
        """Go on until tools are at their goals, wrenches cancel and nothing changes any more.

        Raises
        ------
        PalpateError
            The body does not come to rest: it falls, slides or rolls without end.
        """
        try:
            self._native.settle()
        except RuntimeError as problem:
            raise PalpateError("rest: {problem}", problem=problem) from problem
        return self._felt()

    def _felt(self) -> Rest:
        for number, told in enumerate(self._native.touches()):
            if told["free"]:
                continue
            if number < len(self._tools):
                raise PalpateError(
                    "tool {number} is within the body, which does not feel it; begin outside",
                    number=number,
                )
            raise PalpateError(
                "support {number} is within the body, which does not feel it; lay the body down "
                "clear of it",
                number=number - len(self._tools),
            )
        return self.rest

    def tool_touches(self) -> tuple[ToolTouch, ...]:
        """Touches of the tools in the body's own frame, as those of pinned bodies are."""
        told = self._native.touches()[: len(self._tools)]
        return tuple(
            tool_touch(self.body, tool, Pose(one["position"], one["rotation"]), one)
            for tool, one in zip(self._tools, told, strict=True)
        )

    @property
    def rest(self) -> Rest:
        """Where the body is now."""
        placement = Pose(self._native.position, self._native.rotation)
        touches = [_touch(self.body, placement, told) for told in self._native.touches()]
        return Rest(
            self.body,
            placement,
            tuple(touches[: len(self._tools)]),
            tuple(touches[len(self._tools) :]),
            self._native.elastic,
            self._native.time,
        )


def _surface(body: SoftBody, native: Body, spacing: float | None) -> ToolSurface:
    """Contact points that all supports share."""
    usual = SUPPORT_SPACING * float(np.sqrt(surface_area(body.mesh)))
    points = contact_points(body, usual if spacing is None else spacing)
    return native_surface(native, points, near_correction(body, points))


def _floor_reach(body: SoftBody, settings: RestSettings) -> float:
    """Metres, some millionths of which do not count where the body lies: of how far it sags."""
    size = float(np.linalg.norm(np.ptp(body.mesh.nodes, axis=0)))
    weight = body.mass * float(np.linalg.norm(settings.gravity))
    sag = weight / (body.modulus(settings.young_modulus) * size)
    return min(size, max(REACH_PER_SAG * sag, LEAST_REACH * size))


def _laid(surface: ToolSurface, support: Floor | Support, reach: float) -> LaidTool:
    if isinstance(support, Floor):
        return surface, NativeTool.endless(reach), *_at(support.pose), support.friction
    return surface, native_shape(support.tool), *_at(support.pose), support.friction


def _at(pose: Pose) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return pose.position, pose.rotation


def _touch(body: SoftBody, placement: Pose, told: SettledTool) -> BodyTouch:
    turn = placement.rotation.T
    return BodyTouch(
        force=told["force"] @ turn,
        torque=told["torque"] @ turn,
        places=(told["places"] + told["displacements"]) @ turn + placement.position,
        pushes=told["pushes"],
        areas=told["areas"],
        nodes=body.mesh.surface_nodes[told["nodes"]],
        nodal_forces=told["nodal_forces"],
    )
