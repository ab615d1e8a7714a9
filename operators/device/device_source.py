"""The haptic device of a press: which port, and where its workspace lies in the body."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...simulated.hand.options import SimulatedOptions
from ...simulated.hand.plant import Vector
from ...simulated.simulated_process import SimulatedDevice
from ..object.drawn_body import DrawnBody
from ..scene import ray
from ..scene.body_frame import BodyFrame
from .device_plane import half_extents, upright_plane

Array = NDArray[np.float64]

# The simulated hand starts this far above the body and presses this deep, as shares of its size.
SIMULATED_REST, SIMULATED_DEPTH = 0.15, 0.12
# World directions from which a simulated hand comes: the first's, and a second one's.
FROM_ABOVE, FROM_THE_SIDE = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
# In a plane at most this share of what its arms reach.
SIMULATED_REACH = 0.8


@dataclass(frozen=True, eq=False)
class DeviceFrame:
    """From device to body, metres: ``scale * rotation @ device + translation``."""

    rotation: Array
    translation: Array
    scale: float

    def same_as(self, other: DeviceFrame) -> bool:
        """Whether both map alike."""
        return (
            self.scale == other.scale
            and np.array_equal(self.rotation, other.rotation)
            and np.array_equal(self.translation, other.translation)
        )

    def device_from_body(self, points: Array) -> Array:
        """Points (..., 3) of the body as the device counts them."""
        device: Array = (points - self.translation) @ self.rotation / self.scale
        return device


def frame_of_matrix(matrix: Array, body: BodyFrame, scale: float) -> DeviceFrame:
    """A device whose origin and axes are those of a world matrix (4, 4).

    Raises
    ------
    PalpateError
        It flattens to nothing.
    """
    device = BodyFrame.of_matrix(matrix, body.metres_per_unit)
    return DeviceFrame(
        body.rotation.T @ device.rotation, body.body_from_world(device.origin), scale
    )


def home_of_device(thing: bpy.types.Object, scene: bpy.types.Scene, body: BodyFrame) -> DeviceFrame:
    """Where a device is that no Empty places: at the object's own origin and axes, or upright
    through its top if it moves in a plane.
    """
    if is_planar(scene):
        return frame_of_matrix(upright_plane(thing), body, 1.0)
    return DeviceFrame(np.eye(3), np.zeros(3), 1.0)


def device_frame(scene: bpy.types.Scene, body: BodyFrame, home: DeviceFrame) -> DeviceFrame:
    """Where the device is: at the chosen Empty, else at ``home``.

    Raises
    ------
    PalpateError
        The Empty is flattened to nothing.
    """
    chosen = scene.palpate
    empty = chosen.device_frame
    if empty is None:
        return replace(home, scale=chosen.device_scale)
    try:
        return frame_of_matrix(np.array(empty.matrix_world), body, chosen.device_scale)
    except PalpateError as problem:
        raise PalpateError(
            "Device Frame {name}: {problem}", name=empty.name, problem=problem
        ) from problem


def second_frame(thing: bpy.types.Object, scene: bpy.types.Scene, body: BodyFrame) -> DeviceFrame:
    """Where the second finger's device is: at its Empty, else at the object's origin and axes, or
    upright through its top if it moves in a plane.

    Raises
    ------
    PalpateError
        The Empty is flattened to nothing.
    """
    empty, scale = scene.palpate.second_frame, scene.palpate.device_scale
    if empty is None and scene.palpate.second == "HAPLY":
        return frame_of_matrix(upright_plane(thing), body, scale)
    if empty is None:
        return DeviceFrame(np.eye(3), np.zeros(3), scale)
    try:
        return frame_of_matrix(np.array(empty.matrix_world), body, scale)
    except PalpateError as problem:
        raise PalpateError(
            "Device Frame {name}: {problem}", name=empty.name, problem=problem
        ) from problem


def is_planar(scene: bpy.types.Scene) -> bool:
    """Whether the chosen device moves in a plane."""
    chosen = scene.palpate
    return chosen.source == "HAPLY" or (
        chosen.source == "SIMULATED" and chosen.simulated_kind == "HAPLY"
    )


def port_of(scene: bpy.types.Scene) -> str:
    """The chosen serial port.

    Raises
    ------
    PalpateError
        None is chosen.
    """
    # The list suggests "path (description)".
    port = scene.palpate.port.partition(" (")[0].strip()
    if not port:
        raise PalpateError("device: no port is chosen; pick one in the panel Device")
    return port


def _top(drawn: DrawnBody, up: Array) -> Array:
    """The surface point above the body's middle, where a hand would press it."""
    nodes, triangles = drawn.body.mesh.nodes, drawn.body.mesh.surface_triangles
    above = nodes.mean(axis=0) + 2.0 * drawn.size * up
    hit = ray.first_hit(above, -up, nodes, triangles)
    if hit is None:
        # Nothing there, as in a ring: then the highest place.
        highest: Array = nodes[np.argmax(nodes @ up)]
        return highest
    point: Array = hit.alpha @ nodes[triangles[hit.triangle]]
    return point


def start_simulated(
    drawn: DrawnBody,
    frame: DeviceFrame,
    haply: str | None = None,
    towards: Array = FROM_ABOVE,
) -> SimulatedDevice:
    """Start the simulated device, whose hand presses the body from the world direction ``towards``
    (3,), again and again: on its top, unless told otherwise.

    ``haply`` names the model of a Haply 2DIY to simulate: then it presses in the device's plane,
    as far as its arms reach.

    Raises
    ------
    PalpateError
        It does not start, or this system has no pseudo-terminals.
    """
    up = drawn.frame.turn_to_body(towards)
    above, deep = SIMULATED_REST * drawn.size, SIMULATED_DEPTH * drawn.size
    if haply is None:
        options = _hand(frame, _top(drawn, up), above * up, deep * up)
    else:
        # Its own rest pose, where it begins, is what its angles are counted from.
        reach = SIMULATED_REACH * half_extents(haply)[1] * frame.scale
        above, deep = min(above, reach), min(deep, reach)
        hand = _hand(frame, frame.translation + above * up, 0.0 * up, (above + deep) * up)
        options = replace(hand, rest=SimulatedOptions.rest)
    return SimulatedDevice(
        options, haply=haply, python=sys.executable, python_args=bpy.app.python_args
    )


def _hand(frame: DeviceFrame, at: Array, above: Array, deep: Array) -> SimulatedOptions:
    """A hand that rests ``above`` a place and presses ``deep`` there; vectors of the body, m."""
    return SimulatedOptions(
        rest=_vector(frame.device_from_body(at + above)),
        at=_vector(frame.device_from_body(at)),
        by=_vector(-frame.rotation.T @ deep / frame.scale),
        period=3.0,
        hold=0.5,
    )


def _vector(array: Array) -> Vector:
    x, y, z = array.tolist()
    return (x, y, z)
