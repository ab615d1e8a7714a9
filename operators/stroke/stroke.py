"""Stroke on a body: what it does to the surface, and the force it takes."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...core.contact.place import nearest_place
from ...core.contact.press import ContactSettings, Press
from ...core.contact.tool.pose import Pose, facing, resting_on
from ...core.contact.tool.tool_dent import PressingTool
from ...core.contact.tool.tool_surface import surface_and_correction
from ...core.contact.tool.tools import Tool, sphere
from ...core.contact.touches import ToolTouch
from ...core.grip.held_patch import HeldPatch
from ...core.grip.patch import Grip
from ..object.drawn_body import DrawnBody
from .motion import Asked, Motion

Array = NDArray[np.float64]


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
class Stroke:
    """Stroke at one place of a body and at its mirror images.

    A push is that of a fingertip, by the laws of contact: it only pushes. All else holds a patch
    of the surface (:mod:`...core.grip.held_patch`). Both are made when first asked for.

    Attributes
    ----------
    drawn : the body.
    grips : the place, then its mirror images.
    young_modulus, friction : of the object.
    """

    drawn: DrawnBody
    grips: tuple[Grip, ...]
    young_modulus: float
    friction: float

    def stroked(self, asked: Asked) -> Stroked:
        """What a motion does.

        Raises
        ------
        PalpateError
            The place is pinned; the fingertip is too small for the body.
        """
        # A pull begins at a depth of -0.
        if asked.motion is Motion.PUSH and math.copysign(1.0, asked.amount) > 0.0:
            return self._pushing.to(asked.amount, self.young_modulus)
        answer = self._held.answer(asked.shares(self.grips[0].normal), self.young_modulus)
        force = float(np.linalg.norm(answer.force))
        return Stroked(answer.displacements, force, answer.torque)

    @cached_property
    def _held(self) -> HeldPatch:
        drawn = self.drawn
        normals = drawn.node_normals[drawn.body.mesh.surface_nodes]
        return HeldPatch.of(drawn.body, self.grips, normals)

    @cached_property
    def _pushing(self) -> _Pushing:
        return _Pushing.begin(self.drawn, self.grips, self.friction, self.young_modulus)


@dataclass(frozen=True, eq=False)
class _Pushing:
    """Fingertips set down at their places, and their ways in."""

    press: Press
    starts: tuple[Pose, ...]
    inward: tuple[Array, ...]

    @classmethod
    def begin(
        cls, drawn: DrawnBody, grips: tuple[Grip, ...], friction: float, young_modulus: float
    ) -> _Pushing:
        body, tool = drawn.body, sphere(grips[0].radius)
        samples = surface_and_correction(body, tool)[0].positions
        starts = tuple(_set_down(grip, drawn, tool, samples) for grip in grips)
        press = Press(body, [tool] * len(grips), ContactSettings(young_modulus, friction))
        press.to(starts)
        return cls(press, starts, tuple(-grip.normal for grip in grips))

    def to(self, depth: float, young_modulus: float) -> Stroked:
        touches = self.press.to(
            [
                Pose(start.position + depth * way, start.rotation)
                for start, way in zip(self.starts, self.inward, strict=True)
            ]
        )
        made = [touch for touch in touches if isinstance(touch, ToolTouch)]
        nodes = np.concatenate([touch.nodes for touch in made])
        forces = np.concatenate([touch.nodal_forces for touch in made])
        return Stroked(
            self.press.body.deform(nodes, forces, young_modulus),
            float(np.linalg.norm(made[0].force)),
            touches=tuple(made),
        )


def _set_down(grip: Grip, drawn: DrawnBody, tool: Tool, samples: Array) -> Pose:
    centre = grip.centre(drawn.body.mesh)
    return resting_on(tool, facing(grip.normal, np.eye(3)[0]), centre, grip.normal, samples)


def grips_at(
    drawn: DrawnBody, rest: Array, radius: float, mirrored: tuple[bool, bool, bool]
) -> tuple[Grip, ...]:
    """Grips at ``rest`` (3,), metres, body coordinates, and at its images in the planes through the
    object's origin across those of its axes that are ``mirrored``; none where an image is off the
    surface by more than the radius.
    """
    grips = [_grip(drawn, rest, radius, np.eye(3))]
    metric = drawn.frame.metric
    choices = [(1.0, -1.0) if one else (1.0,) for one in mirrored]
    for signs in list(itertools.product(*choices))[1:]:
        mirror = metric @ np.diag(signs) @ np.linalg.inv(metric)
        image = mirror @ rest
        place = nearest_place(drawn.body, image)
        if np.linalg.norm(place.position - image) <= radius:
            grips.append(_grip(drawn, image, radius, mirror))
    return tuple(grips)


def _grip(drawn: DrawnBody, at: Array, radius: float, mirror: Array) -> Grip:
    place = nearest_place(drawn.body, at)
    corners = drawn.body.mesh.surface_triangles[place.triangle]
    normal = place.alpha @ drawn.node_normals[corners]
    return Grip(place.triangle, place.alpha, normal / np.linalg.norm(normal), radius, mirror)
