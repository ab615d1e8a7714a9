"""The part of ``palpate press`` that presses a tool instead of a point."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.coordinates import refuse_unusable
from ..core.errors import PalpateError
from ..core.soft_body import SoftBody
from ..core.softness.force_depth import facing_pose
from ..core.softness.place import nearest_place
from ..core.tool_contact import ToolTouch, press_tool
from ..core.tools import Pose, Tool


def pressed_tool(
    body: SoftBody, tool: Tool, at: ArrayLike, by: ArrayLike, young_modulus: float
) -> ToolTouch:
    """Set a tool down at the surface point nearest to ``at``, move it by ``by`` (3,) metres.

    Its -z axis looks into the body there, against the smooth normal, and its foremost point is on
    the surface. Then it is moved straight on, without turning.

    Raises
    ------
    PalpateError
        Coordinates that are not three finite numbers.
    """
    way = np.asarray(by, dtype=np.float64)
    if way.shape != (3,):
        raise PalpateError(f"--by: {way.tolist()} is no displacement; give three numbers in metres")
    refuse_unusable("--by", way[None])
    start = facing_pose(nearest_place(body, at), tool, 0.0)
    outside = press_tool(body, tool, start, young_modulus=young_modulus)
    return press_tool(
        body,
        tool,
        Pose(start.position + way, start.rotation),
        young_modulus=young_modulus,
        start=outside,
    )


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
    }


def _along(stiffness: NDArray[np.float64], force: NDArray[np.float64]) -> float:
    """Stiffness in the direction of the force, N/m; zero without a force."""
    size = float(force @ force)
    return float(force @ stiffness @ force) / size if size > 0 else 0.0
