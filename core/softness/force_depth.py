"""Force against depth at a place, for a point or a tool."""

from __future__ import annotations

import io
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..body.soft_body import SoftBody
from ..contact.place import Place, nearest_place
from ..contact.press import ContactSettings, Press
from ..contact.single_press import touch_at
from ..contact.tool.pose import Pose, facing
from ..contact.tool.tools import Tool
from ..errors import PalpateError
from ..sentence import Sentence
from .parallel_rays import thickness

COLUMNS = "depth_mm,force_n,stiffness_n_per_mm,contact_area_mm2"
MILLIMETRES = 1e3

# Default depth of a curve, as a share of the thickness or the tool's size.
SHARE_OF_THICKNESS = 0.2
SHARE_OF_TOOL = 0.25

MOST_STEPS = 1000


@dataclass(frozen=True, eq=False)
class ForceDepthCurve:
    """Force against depth at one place, from the first touch on.

    Attributes
    ----------
    tool : its name; "point" for a point.
    place : position and axis.
    depths : float64 (n,), metres along the axis, from 0 on.
    forces : float64 (n,), newton along the axis.
    stiffness : float64 (n,), slope of the force there, N/m, from the neighbouring depths.
    areas : float64 (n,), square metres in contact; 0 for a point.
    """

    tool: str
    place: Place
    depths: NDArray[np.float64]
    forces: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    areas: NDArray[np.float64]

    @property
    def secant(self) -> float:
        """Force over depth at the last depth, N/m."""
        return float(self.forces[-1] / self.depths[-1])

    def as_csv(self) -> str:
        """CSV of depth in mm, force in N, stiffness in N/mm, contact area in mm2."""
        table = np.column_stack(
            [
                self.depths * MILLIMETRES,
                self.forces,
                self.stiffness / MILLIMETRES,
                self.areas * MILLIMETRES**2,
            ]
        )
        text = io.StringIO()
        np.savetxt(text, table, fmt="%.6g", delimiter=",", header=COLUMNS, comments="")
        return text.getvalue()


def usual_depth(body: SoftBody, at: ArrayLike, tool: Tool | None) -> float:
    """Default depth of a curve, metres."""
    through = SHARE_OF_THICKNESS * thickness(body, nearest_place(body, at))
    return through if tool is None else min(through, SHARE_OF_TOOL * tool.size)


def force_depth_curve(
    body: SoftBody,
    at: ArrayLike,
    depth: float | None = None,
    *,
    tool: Tool | None = None,
    steps: int = 20,
    young_modulus: float | None = None,
) -> ForceDepthCurve:
    """Press straight in at the surface point nearest to ``at`` (3,), metres.

    Parameters
    ----------
    depth : metres; see :func:`usual_depth` without.
    tool : a rigid tool, its -z axis along the axis; None for a point.
    steps : number of depths, without 0.
    young_modulus : pascal; the body's own unless given.

    Raises
    ------
    PalpateError
        A depth, number of steps or Young's modulus that is not positive; a depth beyond the body's
        size.
    """
    modulus = body.modulus(young_modulus)
    place = nearest_place(body, at)
    end = usual_depth(body, at, tool) if depth is None else depth
    for name, value in ((Sentence("depth"), end), (Sentence("Young's modulus"), modulus)):
        if not (np.isfinite(value) and value > 0):
            raise PalpateError(
                "force curve: {name} is {value}; give a positive number", name=name, value=value
            )
    if not 1 <= steps <= MOST_STEPS:
        raise PalpateError(
            "force curve: {steps} steps; give a number from 1 to {most}",
            steps=steps,
            most=MOST_STEPS,
        )
    size = float(np.ptp(body.mesh.nodes, axis=0).max())
    if end > size:
        raise PalpateError(
            "force curve: a depth of {depth:.4g} mm is more than the whole body of {size:.4g} mm; "
            "give less",
            depth=1000.0 * end,
            size=1000.0 * size,
        )
    depths = np.linspace(0.0, end, steps + 1)
    settings = ContactSettings(young_modulus)
    if tool is None:
        return _of_point(body, place, depths, settings)
    return _of_tool(place, depths, Press(body, [tool], settings), tool)


def _of_point(
    body: SoftBody, place: Place, depths: NDArray[np.float64], settings: ContactSettings
) -> ForceDepthCurve:
    """Curve of a point. A point contact is linear: one touch suffices."""
    made = touch_at(body, place.triangle, place.alpha, place.axis, settings)
    stiffness = -float(made.force @ place.axis)
    return ForceDepthCurve(
        "point",
        place,
        depths,
        stiffness * depths,
        np.full(len(depths), stiffness),
        np.zeros(len(depths)),
    )


def _of_tool(
    place: Place, depths: NDArray[np.float64], press: Press, tool: Tool
) -> ForceDepthCurve:
    """Curve of a tool, each depth started from the one before."""
    touches = [press.to([facing_pose(place, tool, depth)])[0] for depth in depths]
    forces = np.array([0.0 - float(made.force @ place.axis) for made in touches])
    areas = np.array([made.area for made in touches])
    stiffness: NDArray[np.float64] = np.gradient(forces, depths)
    return ForceDepthCurve(tool.name, place, depths, forces, stiffness, areas)


def facing_pose(place: Place, tool: Tool, depth: float) -> Pose:
    """Pose of a tool with its -z axis into the body at a place, its foremost point ``depth``
    metres below the rest surface.
    """
    foremost = float(-tool.core[:, 2].min()) + tool.radius
    rotation = facing(-place.axis, np.eye(3)[0])
    return Pose.at(place.position + (depth - foremost) * place.axis, rotation)
