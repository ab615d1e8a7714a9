"""Native form of a tool and its contact points."""

from __future__ import annotations

from typing import TypeAlias

from palpate_servo import Body, ToolSurface
from palpate_servo import Tool as NativeTool

from ...body.soft_body import SoftBody
from ...errors import PalpateError
from ..near_field.compliance_beneath import NearCorrection
from ..near_field.contact_points import ContactPoints
from .tool_surface import Touchable, surface_and_correction
from .tools import Tool

NativeTip: TypeAlias = tuple[ToolSurface, NativeTool]
"""Contact points and shape of a tool."""


def native_surface(native: Body, points: ContactPoints, near: NearCorrection | None) -> ToolSurface:
    """Contact points on a whole native body; without ``near`` as the mesh's elements have it.

    Raises
    ------
    ValueError
        A body that is not whole, or points of another one.
    """
    return ToolSurface(
        native,
        points.positions,
        points.normals,
        points.triangles,
        points.alphas,
        points.areas,
        None if near is None else near.arrays(),
    )


def native_shape(tool: Tool) -> NativeTool:
    """Native shape of a tool."""
    return NativeTool(tool.core, tool.radius)


def native_tool(
    body: SoftBody, native: Body, tool: Tool, touchable: Touchable | None = None
) -> NativeTip:
    """Contact points and shape of a tool, for a finger of the servo.

    Takes some tenths of a second, to spread contact points and to estimate the near field.

    Parameters
    ----------
    native : of ``native_body(body, whole=True)``, the one that the servo touches.
    touchable : points that the tool can press, and their near field; None for those it asks for.

    Raises
    ------
    PalpateError
        A body without its whole compliance, or a tool too small for the body.
    """
    points, near = surface_and_correction(body, tool) if touchable is None else touchable
    try:
        return native_surface(native, points, near), native_shape(tool)
    except ValueError as problem:
        raise PalpateError("tool {name}: {problem}", name=tool.name, problem=problem) from problem
