"""The part of ``palpate press`` that presses a tool instead of a point."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.place import nearest_place
from ...core.contact.press import ContactSettings
from ...core.contact.single_press import pairs_checked, press_tools, set_down
from ...core.contact.tool.tools import Tool
from ...core.contact.touches import ToolTouch


def pressed_tools(
    body: SoftBody,
    tool: Tool,
    at: Sequence[ArrayLike],
    by: Sequence[ArrayLike],
    settings: ContactSettings,
) -> tuple[ToolTouch, ...]:
    """Set tools of one kind down at the surface points nearest to ``at``, move them by ``by``.

    The -z axis of each looks into the body there, against the smooth normal. Then it is moved
    straight on, without turning. Lengths in metres.

    Raises
    ------
    PalpateError
        Coordinates that are not three finite numbers, or not as many of one as of the other; forces
        that do not come to rest.
    """
    places, ways = pairs_checked(at, by)
    starts = [set_down(body, tool, nearest_place(body, place)) for place in places]
    return press_tools(body, tool, starts, ways, settings)


def tool_figures(touch: ToolTouch) -> dict[str, object]:
    """Figures of a tool's touch, as plain values; SI units."""
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
        "exact": True,
    }


def tool_summary(touch: ToolTouch) -> dict[str, object]:
    """The same, short enough to read."""
    return {
        "tool": touch.tool.name,
        "position": touch.pose.position.tolist(),
        "force": touch.force.tolist(),
        "torque": touch.torque.tolist(),
        "pressed_points": len(touch.points),
        "pressed_area_m2": touch.area,
        "largest_pressure_pa": touch.largest_pressure,
        "stiffness_along_force": _along(touch.stiffness, touch.force),
        "exact": True,
    }


def _along(stiffness: NDArray[np.float64], force: NDArray[np.float64]) -> float:
    """Stiffness in the direction of the force, N/m; zero without a force."""
    size = float(force @ force)
    return float(force @ stiffness @ force) / size if size > 0 else 0.0
