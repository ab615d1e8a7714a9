"""The part of ``palpate press`` that presses a tool instead of a point."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.tool.several_tools import press_tools
from ...core.contact.tool.tool_contact import press_tool
from ...core.contact.tool.tool_touch import ToolTouch
from ...core.contact.tool.tools import Pose, Tool
from ...core.errors import PalpateError
from ...core.mesh.coordinates import refuse_unusable
from ...core.softness.force_depth import facing_pose
from ...core.softness.place import nearest_place

# Into how many parts the way of a tool with friction is divided.
STEPS_WITH_FRICTION = 20


def pressed_tools(
    body: SoftBody,
    tool: Tool,
    at: Sequence[ArrayLike],
    by: Sequence[ArrayLike],
    young_modulus: float,
    friction: float,
) -> list[ToolTouch]:
    """Set tools of one kind down at the surface points nearest to ``at``, move them by ``by``.

    The -z axis of each looks into the body there, against the smooth normal, and its foremost point
    is on the surface. Then it is moved straight on, without turning. Lengths in metres.

    Raises
    ------
    PalpateError
        Coordinates that are not three finite numbers, or not as many of one as of the other;
        friction between several tools.
    """
    if len(at) != len(by):
        raise PalpateError(
            f"--at is given {len(at)} times and --by {len(by)} times; give one --by for every --at"
        )
    ways = [np.asarray(way, dtype=np.float64) for way in by]
    for way in ways:
        if way.shape != (3,):
            raise PalpateError(f"--by: {way.tolist()} is no displacement; give three numbers")
        refuse_unusable("--by", way[None])
    starts = [facing_pose(nearest_place(body, place), tool, 0.0) for place in at]
    ends = [
        Pose(start.position + way, start.rotation) for start, way in zip(starts, ways, strict=True)
    ]
    if len(starts) == 1:
        # With friction it matters how the tool came: points stick where they are first pressed.
        between = np.linspace(0.0, 1.0, 1 + (STEPS_WITH_FRICTION if friction else 1))
        touch: ToolTouch | None = None
        for share in between:
            pose = Pose(starts[0].position + share * ways[0], starts[0].rotation)
            touch = press_tool(
                body, tool, pose, young_modulus=young_modulus, friction=friction, start=touch
            )
        return [touch] if touch is not None else []
    if friction:
        raise PalpateError("--friction: it is there for one tool; leave it out with several")
    outsides = press_tools(body, [(tool, pose) for pose in starts], young_modulus=young_modulus)
    together = [(tool, pose) for pose in ends]
    return press_tools(body, together, young_modulus=young_modulus, start=outsides)


def tool_figures(touch: ToolTouch) -> dict[str, object]:
    """What a touch by a tool comes to, as plain values; SI units."""
    return {
        "tool": touch.tool.name,
        "position": touch.pose.position.tolist(),
        "rotation": touch.pose.rotation.tolist(),
        "points": touch.places.tolist(),
        "point_displacements": touch.displacements.tolist(),
        "pressures": touch.pressures.tolist(),
        "nodes": touch.nodes.tolist(),
        "nodal_forces": touch.nodal_forces.tolist(),
        "force": touch.force.tolist(),
        "torque": touch.torque.tolist(),
        "stiffness": touch.stiffness.tolist(),
        "exact": touch.exact,
    }


def tool_summary(touch: ToolTouch) -> dict[str, object]:
    """The same, short enough to read."""
    area = float(touch.surface.areas[touch.points].sum())
    return {
        "tool": touch.tool.name,
        "position": touch.pose.position.tolist(),
        "force": touch.force.tolist(),
        "torque": touch.torque.tolist(),
        "pressed_points": len(touch.points),
        "pressed_area_m2": area,
        "largest_pressure_pa": float(touch.pressures.max(initial=0.0)),
        "stiffness_along_force": _along(touch.stiffness, touch.force),
        "exact": touch.exact,
    }


def _along(stiffness: NDArray[np.float64], force: NDArray[np.float64]) -> float:
    """Stiffness in the direction of the force, N/m; zero without a force."""
    size = float(force @ force)
    return float(force @ stiffness @ force) / size if size > 0 else 0.0
