"""Press of fingers on a body without a clock: by the native engine, stepped until it settles.

Used by scripts, command line, animations and softness measurements; forces are those of the servo's
fingers at the same places.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray
from palpate_servo import ContactEngine, ToolSurface

from ..body.native_body import native_body
from ..body.soft_body import SoftBody
from ..errors import PalpateError
from .equations import CONTACT_MODES, ContactMode
from .near_field.compliance_beneath import NearCorrection
from .near_field.contact_points import ContactPoints
from .tool.native_tool import native_shape, native_surface
from .tool.pose import Pose
from .tool.tool_surface import surface_and_correction
from .tool.tools import Tool
from .touches import PointTouch, ToolTouch, Touch
from .unsettled import NotANumberError, UnsettledError

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import Body, SettledPoint, SettledTool
    from palpate_servo import Tool as NativeTool

Array = NDArray[np.float64]
Spread: TypeAlias = tuple[ContactPoints, NearCorrection | None]
"""Contact points, and what their compliance is besides the mesh's; None for the mesh's alone."""


@dataclass(frozen=True)
class ContactSettings:
    """Settings of a contact.

    Attributes
    ----------
    young_modulus : pascal; None for the body's own.
    friction : coefficient of Coulomb friction between tools and body; points always stick.
    mode : of points. In ``consistent`` the contact point moves by exactly the finger's displacement
        (but for pinned nodes, which do not move), fingers act on each other through the body and
        only push. In ``paper`` the force of each is that of (11)-(14) for one alone.
    """

    young_modulus: float | None = None
    friction: float = 0.0
    mode: ContactMode = "consistent"


USUAL = ContactSettings()

# Times the body's size. A larger radius has no digits left for where it touches.
LARGEST_RADIUS = 1e6


@dataclass(frozen=True, eq=False)
class PointGoal:
    """Goal of a point: to move surface triangle number ``triangle`` at area coordinates ``alpha``
    (3,) ``by`` (3,), metres. For zero it holds the place against the normal.
    """

    triangle: int
    alpha: Array
    by: Array


class Press:
    """Fingers on one body, with warm start: each call continues from the state of the last."""

    def __init__(
        self,
        body: SoftBody,
        tips: Sequence[Tool | None],
        settings: ContactSettings = USUAL,
        *,
        spread: Spread | None = None,
    ) -> None:
        """Fingers without contact.

        Parameters
        ----------
        tips : a tool for each finger, None for a point.
        spread : contact points for all tools, in place of those of :mod:`.tool.tool_surface`.

        Raises
        ------
        PalpateError
            Invalid settings or number of fingers; a tool too small for the body.
        """
        self.body, self.tips = body, tuple(tips)
        modulus = body.modulus(settings.young_modulus)
        if settings.mode not in CONTACT_MODES:
            raise PalpateError(
                "contact mode {mode} is unknown; give {known}",
                mode=repr(settings.mode),
                known=" or ".join(CONTACT_MODES),
            )
        some_tool = any(tip is not None for tip in self.tips)
        native = native_body(body, whole=some_tool or len(self.tips) > 1)
        try:
            self._engine = ContactEngine(
                native,
                _native_tips(body, native, self.tips, spread),
                young_modulus=modulus,
                friction=settings.friction,
                mode=settings.mode,
            )
        except ValueError as problem:
            raise PalpateError("press: {problem}", problem=problem) from problem

    def to(self, goals: Sequence[PointGoal | Pose]) -> tuple[Touch, ...]:
        """Settled contact of all fingers at their goals, one each.

        They move together, straight, in strides so short that no tool passes through a wall. First
        goals of tools are approached from outside, against the direction of the body's push.

        Raises
        ------
        UnsettledError, NotANumberError
            The forces do not settle, or one is no number.
        PalpateError
            An invalid goal.
        """
        targets = [
            (goal.position, goal.rotation)
            if isinstance(goal, Pose)
            else (goal.triangle, goal.alpha, goal.by)
            for goal in goals
        ]
        try:
            settled = self._engine.settle(targets)
        except (ValueError, FloatingPointError, RuntimeError) as problem:
            raise _kind_of(problem)("press: {problem}", problem=problem) from problem
        return tuple(_touch(self.body, *one) for one in zip(self.tips, goals, settled, strict=True))


def _kind_of(problem: Exception) -> type[PalpateError]:
    """What an error of the native engine is to a user."""
    match problem:
        case FloatingPointError():
            return NotANumberError
        case RuntimeError():
            return UnsettledError
    return PalpateError


def _native_tips(
    body: SoftBody,
    native: Body,
    tips: Sequence[Tool | None],
    spread: Spread | None,
) -> list[tuple[ToolSurface, NativeTool] | None]:
    """Contact points and shape of each tip. Equal points are shared, so that tools have a common
    near field.
    """
    size = float(np.linalg.norm(np.ptp(body.mesh.nodes, axis=0)))
    surfaces: dict[int, ToolSurface] = {}
    native_tips: list[tuple[ToolSurface, NativeTool] | None] = [None] * len(tips)
    for number, tool in enumerate(tips):
        if tool is None:
            continue
        points, near = surface_and_correction(body, tool) if spread is None else spread
        if tool.radius > LARGEST_RADIUS * size:
            raise PalpateError(
                "tool {name}: its radius of {radius:g} m is over {most:g} times the body's size; "
                "give a plate",
                name=tool.name,
                radius=tool.radius,
                most=LARGEST_RADIUS,
            )
        if id(points) not in surfaces:
            surfaces[id(points)] = native_surface(native, points, near)
        native_tips[number] = surfaces[id(points)], native_shape(tool)
    return native_tips


def _touch(
    body: SoftBody, tip: Tool | None, goal: PointGoal | Pose, told: SettledPoint | SettledTool
) -> Touch:
    if tip is not None and isinstance(goal, Pose):
        return tool_touch(body, tip, goal, cast("SettledTool", told))
    return _point_touch(body, cast("PointGoal", goal), cast("SettledPoint", told))


def _point_touch(body: SoftBody, goal: PointGoal, told: SettledPoint) -> PointTouch:
    corners = body.mesh.surface_triangles[goal.triangle]
    point = goal.alpha @ body.mesh.nodes[corners]
    return PointTouch(corners, goal.alpha, point, goal.by, told["force"], told["nodal_forces"])


def tool_touch(body: SoftBody, tool: Tool, pose: Pose, told: SettledTool) -> ToolTouch:
    """Touch of a tool at a pose, both of the body's frame, as the native engine tells it."""
    order = np.argsort(told["points"])
    return ToolTouch(
        body=body,
        tool=tool,
        pose=pose,
        force=told["force"],
        torque=told["torque"],
        stiffness=told["stiffness"],
        points=told["points"][order],
        places=told["places"][order],
        displacements=told["displacements"][order],
        normals=told["normals"][order],
        forces=told["point_forces"][order],
        pushes=told["pushes"][order],
        areas=told["areas"][order],
        nodes=body.mesh.surface_nodes[told["nodes"]],
        nodal_forces=told["nodal_forces"],
    )
