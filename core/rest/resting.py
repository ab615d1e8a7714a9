"""A free body under its weight, on supports, pressed by tools and points: step by step, or until it
rests.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, cast

import numpy as np
from palpate_servo import MAX_FINGERS
from palpate_servo import Resting as NativeResting

from ..body.native_body import native_body
from ..body.soft_body import SoftBody
from ..contact.press import tool_touch
from ..contact.tool.native_tool import native_tool
from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool
from ..contact.touches import ToolTouch
from ..errors import PalpateError
from .bearing_points import bearing_points, pressing_points
from .grip import Grip, native_grip
from .prop import at, native_prop
from .refusals import SwallowedError, one_goal_each, rest_errors
from .rest import BodyTouch, Rest
from .rest_settings import USUAL_REST, RestSettings
from .support import Floor, Support, as_tool, friction_checked

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import LaidPoint, LaidTool, Prop, RestTouch, SettledTool


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
    tools : what may press it, with their poses in the world, outside of it; of a grip the position
        counts, to which its place is led.
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
        tools: Sequence[tuple[Tool | Grip, Pose]] = (),
        *,
        placement: Pose | None = None,
        settings: RestSettings = USUAL_REST,
    ) -> None:
        if len(tools) > MAX_FINGERS:
            raise PalpateError(
                "{tools} tools touch the body; at most {most_tools} may",
                tools=len(tools),
                most_tools=MAX_FINGERS,
            )
        friction_checked(settings.friction)
        self.body = body
        self._material = self.young_modulus = body.modulus(settings.young_modulus)
        native = self.native_body = native_body(body, whole=True, may_move=True)
        prop = native_prop(
            body, native, supports, placement, settings, bearing_points(body, settings.spacing)
        )

        def finger(tip: Tool | Grip, pose: Pose) -> LaidTool | LaidPoint:
            if isinstance(tip, Grip):
                return native_grip(body, tip, pose)
            points = pressing_points(body, tip, settings.spacing)
            return *native_tool(body, native, tip, points), *at(pose), settings.friction

        with rest_errors(ValueError):
            self._native = NativeResting(
                prop,
                young_modulus=self.young_modulus,
                fingers=[finger(tip, pose) for tip, pose in tools],
            )
        self._tools = tuple(tool for tool, _ in tools)
        self._supports, self._friction = list(supports), settings.friction
        self._let_go = settings.let_go

    @property
    def bodies(self) -> tuple[SoftBody]:
        """It alone."""
        return (self.body,)

    @property
    def firmness(self) -> tuple[float]:
        """How many times as firm as its material it is."""
        return (self.young_modulus / self._material,)

    def firm(self, firmness: Sequence[float]) -> None:
        """Have the body be so many times as firm as its material, from the next step on."""
        (times,) = firmness
        self.young_modulus = times * self._material
        self._native.set_young_modulus(self.young_modulus)

    def laid(self) -> Prop:
        """The body as it lies now, for a servo on its ``native_body`` that goes on from here."""
        return self._native.laid()

    def place(self, placement: Pose) -> None:
        """Lay the body elsewhere; its contacts are found anew."""
        self._native.place(*at(placement))

    def come_in(self) -> None:
        """What overlaps the body comes in from outside, while the body stays where it is: so one
        that rested elsewhere goes on from there.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        with rest_errors(RuntimeError):
            self._native.come_in()

    def move_support(self, number: int, pose: Pose) -> None:
        """Have a support be elsewhere from the next step on."""
        self._native.lead_support(number, *at(pose))
        moved = self._supports[number]
        if isinstance(moved, Support):
            self._supports[number] = replace(moved, pose=pose)

    def lead(self, goals: Sequence[Pose]) -> None:
        """Have the tools go to their goals, one each, from the next step on."""
        one_goal_each(goals, self._tools)
        for number, goal in enumerate(goals):
            self._native.lead(number, *at(goal))

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
        with rest_errors(ValueError, RuntimeError):
            self._native.tick(seconds, hurried=hurried)

    def hurry(self, seconds: float) -> None:
        """The same tick, hurried."""
        self.tick(seconds, hurried=True)

    def settle(self) -> Rest:
        """Go on until tools are at their goals, wrenches cancel and nothing changes any more.

        Raises
        ------
        RestlessError
            The body does not come to rest: it falls, slides or rolls without end.
        SwallowedError
            A tool or a support is wholly within it.
        """
        with rest_errors(RuntimeError):
            self._native.settle()
        return self._felt()

    def settle_on(self, ticks: int) -> bool:
        """Go on with settling by so many ticks at most; whether it rests.

        Raises
        ------
        RestlessError, SwallowedError
            As of :meth:`settle`.
        """
        with rest_errors(RuntimeError):
            rests = self._native.settle_on(ticks)
        if rests:
            self._felt()
        return rests

    def _felt(self) -> Rest:
        for number, told in enumerate(self._native.touches()):
            if told["free"]:
                continue
            if number < len(self._tools):
                raise SwallowedError(
                    "tool {number} is within the body, which does not feel it; begin outside",
                    number=number,
                )
            raise SwallowedError(
                "support {number} is within the body, which does not feel it; lay the body down "
                "clear of it",
                number=number - len(self._tools),
            )
        return self.rest

    def tool_touches(self) -> tuple[ToolTouch, ...]:
        """Touches of the tools, without the grips, in the body's own frame, as those of pinned
        bodies are.
        """
        pairs = zip(self._tools, self._native.touches(), strict=False)
        tools = (
            (tool, cast("SettledTool", told)) for tool, told in pairs if not isinstance(tool, Grip)
        )
        return tuple(
            tool_touch(self.body, tool, Pose(told["position"], told["rotation"]), told)
            for tool, told in tools
        )

    def _pressing(self, placement: Pose) -> list[tuple[Tool, Pose] | None]:
        """All that may touch it in the body's own frame: tools, None of a grip, and supports."""
        told = self._native.touches()
        found: list[tuple[Tool, Pose] | None] = []
        for tool, one in zip(self._tools, told, strict=False):
            if isinstance(tool, Grip):
                found.append(None)
            else:
                laid = cast("SettledTool", one)
                found.append((tool, Pose(laid["position"], laid["rotation"])))
        centre = placement.to_world(self.body.inertia.centre)
        size = float(np.ptp(self.body.mesh.nodes, axis=0).max())
        for support in self._supports:
            tool, pose = as_tool(support, centre, size)
            found.append((tool, placement.pose_to_tool(pose)))
        return found

    @property
    def rest(self) -> Rest:
        """Where the body is now."""
        placement = Pose(self._native.position, self._native.rotation)
        friction = [self._friction] * len(self._tools)
        friction += [support.friction for support in self._supports]
        told = zip(self._native.touches(), self._pressing(placement), friction, strict=True)
        touches = [_touch(self.body, placement, *one) for one in told]
        return Rest(
            self.body,
            placement,
            tuple(touches[: len(self._tools)]),
            tuple(touches[len(self._tools) :]),
            self._native.elastic,
            self._native.time,
            self.young_modulus,
            let_go=None if self._let_go is None else self._let_go @ placement.rotation,
        )

    @property
    def rests(self) -> tuple[Rest]:
        """The same, of it alone."""
        return (self.rest,)


def _touch(
    body: SoftBody,
    placement: Pose,
    told: RestTouch,
    by: tuple[Tool, Pose] | None,
    friction: float,
) -> BodyTouch:
    turn = placement.rotation.T
    return BodyTouch(
        force=told["force"] @ turn,
        torque=told["torque"] @ turn,
        at_rest=told["places"],
        places=(told["places"] + told["displacements"]) @ turn + placement.position,
        pushes=told["pushes"],
        areas=told["areas"],
        nodes=body.mesh.surface_nodes[told["nodes"]],
        nodal_forces=told["nodal_forces"],
        by=by,
        friction=friction,
    )
