"""Workspace of a device: a box in the view, or a rectangle for a planar one."""

from __future__ import annotations

import itertools

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...operators.device import device_plane, device_source
from ...operators.device.device_source import DeviceFrame
from ...operators.scene import drawn_surface
from ...operators.scene.body_frame import BodyFrame
from ...operators.session.press_events import Source
from ...operators.session.press_session import PressSession

Array = NDArray[np.float64]

CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
# Pairs of corners that differ in one axis: the edges.
EDGES = [
    (a, b) for a, b in itertools.combinations(range(8), 2) if np.sum(CORNERS[a] != CORNERS[b]) == 1
]


def outline(context: bpy.types.Context, session: PressSession | None) -> list[tuple[Array, Array]]:
    """Ends of the lines to draw, world coordinates; none if unknown."""
    if not context.scene.palpate.show_workspace:
        return []
    return _of_plane(context) if session is None else _of_device(session)


def _of_device(session: PressSession) -> list[tuple[Array, Array]]:
    """Outline sent by the pressing device."""
    loop = session.loop
    if session.state.source is not Source.DEVICE or loop is None or loop.figures.counters is None:
        return []
    device = loop.figures.counters["link"]["device"]
    frame = loop.settings.devices[0]
    if device is None or frame is None:
        return []
    return _lines(np.array(device["half_extents"]), frame, session.hands[0])


def _of_plane(context: bpy.types.Context) -> list[tuple[Array, Array]]:
    """Outline before a press, for a planar device, which needs placing."""
    thing, scene = context.object, context.scene
    if thing is None or not thing.palpate.body_key or not device_source.is_planar(scene):
        return []
    try:
        body = drawn_surface.frame_of(thing, scene)
        home = device_source.home_of_device(thing, scene, body)
        frame = device_source.device_frame(thing, scene, body, home)
    except PalpateError:
        # A flattened transform; Press reports it with its remedy.
        return []
    extents = (*device_plane.half_extents(scene.palpate.haply_model), 0.0)
    return _lines(np.array(extents), frame, body)


def _lines(extents: Array, device: DeviceFrame, body: BodyFrame) -> list[tuple[Array, Array]]:
    corners = device.scale * (CORNERS * extents) @ device.rotation.T + device.translation
    world = body.world_from_body(corners)
    # A missing axis has no edges, and parallel ones coincide.
    return [
        (world[a], world[b])
        for a, b in EDGES
        if _extent_along(a, b, extents) > 0.0 and not _is_double(a, extents)
    ]


def _extent_along(a: int, b: int, extents: Array) -> float:
    return float(extents[np.argmax(CORNERS[a] != CORNERS[b])])


def _is_double(corner: int, extents: Array) -> bool:
    return bool(np.any((extents == 0.0) & (CORNERS[corner] > 0.0)))
