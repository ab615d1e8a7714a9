"""Haptic device of a press: its port, and the frame of its workspace in the body."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.pose import Pose, resting_on
from ...core.errors import PalpateError
from ...core.rest.prop import WORLD
from ...simulated.hand.options import SimulatedOptions
from ...simulated.simulated_process import SimulatedDevice
from ..object.drawn_body import DrawnBody
from ..place import ray
from ..scene import drawn_surface
from ..scene.body_frame import BodyFrame, as_point
from ..tool.finger_tip import FingerTip
from .device_plane import half_extents, upright_plane

Array = NDArray[np.float64]

# Start of the simulated hand above the body and depth of its presses, as shares of the body's size.
SIMULATED_REST, SIMULATED_DEPTH = 0.15, 0.12
# Height of a tool above the surface between its presses, likewise.
SIMULATED_AIR = 0.01
# World directions from which the first and the second simulated hand come.
FROM_ABOVE, FROM_THE_SIDE = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
POINT = FingerTip()
# Largest share of the arms' reach that is used in a plane.
SIMULATED_REACH = 0.8


@dataclass(frozen=True, eq=False)
class DeviceFrame:
    """Map from device to body, metres: ``scale * rotation @ device + translation``."""

    rotation: Array
    translation: Array
    scale: float

    def device_from_body(self, points: Array) -> Array:
        """Points (..., 3) of the body in the device's coordinates."""
        device: Array = (points - self.translation) @ self.rotation / self.scale
        return device


def frame_of_matrix(matrix: Array, body: BodyFrame, scale: float) -> DeviceFrame:
    """Frame with the origin and axes of a world matrix (4, 4).

    Raises
    ------
    PalpateError
        It flattens to nothing.
    """
    device = BodyFrame.of_matrix(matrix, body.metres_per_unit)
    return DeviceFrame(
        body.rotation.T @ device.rotation, body.body_from_world(device.origin), scale
    )


def home_of_device(
    thing: bpy.types.Object, scene: bpy.types.Scene, body: BodyFrame, finger: int = 0
) -> DeviceFrame:
    """Frame without an Empty of the first or the second finger's device: at the object's origin
    and axes, or upright through its top for a planar device.
    """
    planar = scene.palpate.second == "HAPLY" if finger else is_planar(scene)
    if planar:
        return frame_of_matrix(upright_plane(thing), body, 1.0)
    return DeviceFrame(np.eye(3), np.zeros(3), 1.0)


def _in_pose(home: DeviceFrame, of_object: BodyFrame, local: BodyFrame) -> DeviceFrame:
    """A frame in the body of an object at rest, in a local frame of its pose: the same one in the
    world.
    """
    return replace(
        home,
        rotation=local.rotation.T @ of_object.rotation @ home.rotation,
        translation=local.body_from_world(of_object.world_from_body(home.translation)),
    )


def device_frame(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    body: BodyFrame,
    home: DeviceFrame,
    finger: int = 0,
    of_object: BodyFrame | None = None,
) -> DeviceFrame:
    """Frame of the first or the second finger's device: of its Empty, else ``home``, which is in
    the body at rest. ``body`` is the finger's local frame, ``of_object`` that of the object, None
    for where it is now.

    Raises
    ------
    PalpateError
        The Empty is flattened to nothing.
    """
    chosen = scene.palpate
    empty = chosen.second_frame if finger else chosen.device_frame
    if empty is None:
        of_object = of_object or drawn_surface.frame_of(thing, scene)
        return replace(_in_pose(home, of_object, body), scale=chosen.device_scale)
    return _frame_of_empty(empty, body, chosen.device_scale)


def _frame_of_empty(empty: bpy.types.Object, body: BodyFrame, scale: float) -> DeviceFrame:
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
    """Chosen serial port.

    Raises
    ------
    PalpateError
        None is chosen.
    """
    # Entries of the list are "path (description)".
    port = scene.palpate.port.partition(" (")[0].strip()
    if not port:
        raise PalpateError("device: no port is chosen; pick one in the panel Device")
    return port


def _top(drawn: DrawnBody, up: Array, where: Pose) -> Array:
    """Surface point above the middle of a body that is placed there."""
    nodes, triangles = where.to_world(drawn.body.mesh.nodes), drawn.body.mesh.surface_triangles
    above = nodes.mean(axis=0) + 2.0 * drawn.size * up
    hit = ray.first_hit(above, -up, nodes, triangles)
    if hit is None:
        # None, as in a ring: the highest point.
        highest: Array = nodes[np.argmax(nodes @ up)]
        return highest
    point: Array = hit.alpha @ nodes[triangles[hit.triangle]]
    return point


def start_simulated(
    drawn: DrawnBody,
    frame: DeviceFrame,
    up: Array = FROM_ABOVE,
    haply: str | None = None,
    tip: FingerTip = POINT,
    where: Pose = WORLD,
) -> SimulatedDevice:
    """Start the simulated device, whose hand presses the body from the direction ``up`` (3,), the
    hand's axes, repeatedly, by default on its top, with the surface of its ``tip``. The body is
    placed ``where``, as the hand sees it.

    ``haply`` is the model of a Haply 2DIY to simulate: it presses in the device's plane, within
    its arms' reach.

    Raises
    ------
    PalpateError
        It does not start.
    """
    above, deep = SIMULATED_REST * drawn.size, min(SIMULATED_DEPTH * drawn.size, tip.deepest)
    top = _top(drawn, up, where)
    lift = 0.0
    if tip.tool is not None:
        # Out of contact with all of the surface between its presses: only so it can come anew.
        resting = resting_on(tip.tool, np.eye(3), top, up, where.to_world(drawn.surface_nodes))
        lift = float((resting.position - top) @ up) + SIMULATED_AIR * drawn.size
        deep += SIMULATED_AIR * drawn.size
    if haply is None:
        options = _hand(frame, top + lift * up, above * up, deep * up)
    else:
        # Its angles count from its rest pose, where it begins.
        reachable = SIMULATED_REACH * half_extents(haply)[1] * frame.scale
        above, deep = min(above, reachable - lift), min(deep, reachable)
        start = frame.translation + (lift + above) * up
        hand = _hand(frame, start, 0.0 * up, (above + deep) * up)
        options = replace(hand, rest=SimulatedOptions.rest)
    return SimulatedDevice(
        options, haply=haply, python=sys.executable, python_args=bpy.app.python_args
    )


def _hand(frame: DeviceFrame, at: Array, above: Array, deep: Array) -> SimulatedOptions:
    """Options of a hand that rests ``above`` a place and presses ``deep``; body vectors, m."""
    return SimulatedOptions(
        rest=as_point(frame.device_from_body(at + above)),
        at=as_point(frame.device_from_body(at)),
        by=as_point(-frame.rotation.T @ deep / frame.scale),
        period=3.0,
        hold=0.5,
    )
