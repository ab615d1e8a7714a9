"""Where bodies of a pile can be touched, and by what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from palpate_servo import Tool as NativeTool

from ..body.native_body import native_body
from ..body.soft_body import SoftBody
from ..contact.near_field.contact_points import ContactPoints
from ..contact.tool.native_tool import native_shape, native_surface
from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool
from ..rest.bearing_points import bearing_points, pressing_points
from ..rest.prop import at
from ..rest.support import Floor, Support

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import Body, RigidTool, ToolSurface


def rigid(support: Floor | Support, size: float) -> RigidTool:
    """A support as bodies of a size, metres, meet it."""
    tool = NativeTool.endless(size) if isinstance(support, Floor) else native_shape(support.tool)
    return tool, *at(support.pose), support.friction, False


def nearest(bodies: Sequence[tuple[SoftBody, Pose]], pose: Pose) -> SoftBody:
    """The body with the surface node nearest to where a tool is."""

    def away(body: SoftBody, placement: Pose) -> float:
        nodes = body.mesh.nodes[body.mesh.surface_nodes]
        return float(np.linalg.norm(placement.to_world(nodes) - pose.position, axis=1).min())

    return min(bodies, key=lambda one: away(*one))[0]


@dataclass(frozen=True, eq=False)
class Touched:
    """Where a body can be touched: at ``points`` of its ``surface``, and behind these at those of
    hands, where they ask for closer ones.
    """

    native: Body
    points: ContactPoints
    surface: ToolSurface
    by_hands: ToolSurface | None

    @classmethod
    def of(cls, body: SoftBody, hands: Sequence[Tool], spacing: float | None) -> Touched:
        """Points as close as the ``hands`` with the smallest tool ask for."""
        native = native_body(body, whole=True, may_move=True)
        points, near = bearing_points(body, spacing)
        surface = native_surface(native, points, near)
        smallest = min(hands, key=lambda tool: tool.spacing, default=None)
        if smallest is None:
            return cls(native, points, surface, None)
        closer, near = pressing_points(body, smallest, spacing)
        if closer is points:
            return cls(native, points, surface, None)
        by_hands = native_surface(native, closer, near)
        return cls(native, points.followed_by(closer), surface, by_hands)
