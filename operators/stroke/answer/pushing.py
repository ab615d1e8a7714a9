"""Push of a stroke: fingertips on a body, by the laws of contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.contact.press import ContactSettings, Press
from ....core.contact.tool.pose import Pose, facing, resting_on
from ....core.contact.tool.tool_dent import PressingTool
from ....core.contact.tool.tool_surface import surface_and_correction
from ....core.contact.tool.tools import Tool, sphere
from ....core.contact.touches import ToolTouch
from ....core.errors import PalpateError
from ....core.grip.patch import Grip
from ...object.drawn_body import DrawnBody
from .grips import grip_at
from .motion import Asked

Array = NDArray[np.float64]

# Radii by which what is beside it may keep a fingertip off its place.
FARTHEST_OFF = 0.5


@dataclass(frozen=True, eq=False)
class Stroked:
    """Result of a stroke.

    Attributes
    ----------
    displacements : float64 (n, 3), of the free surface nodes, metres.
    force : newton; at the first place where it is mirrored.
    torque : newton metres about the normal there.
    touches : of the tools that press, for drawing.
    """

    displacements: Array
    force: float
    torque: float = 0.0
    touches: tuple[ToolTouch, ...] = ()

    @property
    def tools(self) -> tuple[PressingTool, ...]:
        """The tools that press."""
        return tuple(PressingTool(one.tool, one.pose, one.force) for one in self.touches)


@dataclass(frozen=True, eq=False)
class Pushing:
    """Fingertips set down at their places.

    Attributes
    ----------
    drawn : the body.
    grips : the places.
    tool : the fingertip.
    samples : float64 (n, 3), places that it may touch.
    press : of all of them.
    """

    drawn: DrawnBody
    grips: tuple[Grip, ...]
    tool: Tool
    samples: Array
    press: Press

    @classmethod
    def begin(
        cls, drawn: DrawnBody, grips: tuple[Grip, ...], friction: float, young_modulus: float
    ) -> Pushing:
        """Set fingertips down.

        Raises
        ------
        PalpateError
            They are too small for the body.
        """
        body, tool = drawn.body, sphere(grips[0].radius)
        samples = surface_and_correction(body, tool)[0].positions
        press = Press(body, [tool] * len(grips), ContactSettings(young_modulus, friction))
        begun = cls(drawn, grips, tool, samples, press)
        if begun.reaches:
            press.to([begun._set_down(grip) for grip in grips])
        return begun

    @property
    def reaches(self) -> bool:
        """Whether a fingertip gets to its place without being held off by what is beside it."""
        grip = self.grips[0]
        off = self._set_down(grip).position - grip.centre(self.drawn.body.mesh)
        farthest = (1.0 + FARTHEST_OFF) * self.tool.radius
        return float(np.linalg.norm(off)) <= farthest

    def to(self, asked: Asked, young_modulus: float) -> Stroked:
        """What fingertips do that have gone in and, with the surface, sideways.

        Raises
        ------
        PalpateError
            They go no deeper.
        """
        try:
            touches = self.press.to([self._pose(grip, asked) for grip in self.grips])
        except PalpateError as problem:
            raise PalpateError(
                "This is as deep as the fingertip goes here; a larger one goes deeper"
            ) from problem
        made = [touch for touch in touches if isinstance(touch, ToolTouch)]
        nodes = np.concatenate([touch.nodes for touch in made])
        forces = np.concatenate([touch.nodal_forces for touch in made])
        return Stroked(
            self.press.body.deform(nodes, forces, young_modulus),
            float(np.linalg.norm(made[0].force)),
            touches=tuple(made),
        )

    def _pose(self, grip: Grip, asked: Asked) -> Pose:
        """Where a fingertip goes: along the surface, then in."""
        if asked.by is not None and asked.by.any():
            beside = grip.centre(self.drawn.body.mesh) + grip.mirror @ asked.by
            grip = grip_at(self.drawn, beside, grip.radius, grip.mirror)
        start = self._set_down(grip)
        return Pose(start.position - asked.amount * grip.normal, start.rotation)

    def _set_down(self, grip: Grip) -> Pose:
        turn = facing(grip.normal, np.eye(3)[0])
        centre = grip.centre(self.drawn.body.mesh)
        return resting_on(self.tool, turn, centre, grip.normal, self.samples)
