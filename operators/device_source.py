"""The haptic device of a press: which port, and where its workspace lies in the body."""

from __future__ import annotations

import sys
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.devices.simulated_options import SimulatedOptions
from ..core.devices.simulated_process import SimulatedDevice
from ..core.errors import PalpateError
from . import ray
from .body_frame import BodyFrame
from .drawn_body import DrawnBody

Array = NDArray[np.float64]

# The simulated hand starts this far above the body and presses this deep, as shares of its size.
SIMULATED_REST, SIMULATED_DEPTH = 0.15, 0.12


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


def device_frame(scene: bpy.types.Scene, body: BodyFrame) -> DeviceFrame:
    """Where the device is: at the chosen Empty, else at the object's own origin and axes."""
    chosen = scene.palpate
    empty = chosen.device_frame
    if empty is None:
        return DeviceFrame(np.eye(3), np.zeros(3), chosen.device_scale)
    device = BodyFrame.of_matrix(np.array(empty.matrix_world), body.metres_per_unit)
    return DeviceFrame(
        body.rotation.T @ device.rotation,
        body.body_from_world(device.origin),
        chosen.device_scale,
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


def start_simulated(drawn: DrawnBody, frame: DeviceFrame) -> SimulatedDevice:
    """Start the simulated device, whose hand presses on the top of the body, again and again.

    Raises
    ------
    PalpateError
        It does not start, or this system has no pseudo-terminals.
    """
    up = drawn.frame.turn_to_body(np.array([0.0, 0.0, 1.0]))
    top = _top(drawn, up)
    rest, deep = top + SIMULATED_REST * drawn.size * up, -SIMULATED_DEPTH * drawn.size * up
    x, y, z = frame.device_from_body(rest).tolist()
    at = frame.device_from_body(top).tolist()
    by = (frame.rotation.T @ deep / frame.scale).tolist()
    options = SimulatedOptions(rest=(x, y, z), at=tuple(at), by=tuple(by), period=3.0, hold=0.5)
    return SimulatedDevice(options, python=sys.executable, python_args=bpy.app.python_args)
