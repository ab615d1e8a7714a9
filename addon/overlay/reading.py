"""Measurements of a press, for panel and HUD."""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.tools import Tool
from ...core.servo.session import FingerSnapshot
from ...operators.scene.body_frame import BodyFrame
from ...operators.session.press_session import PressSession
from ...operators.session.press_state import Phase
from ...operators.tool.tool_depth import finger_depth

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Patch:
    """Contact patch of a tool: places (p, 3) and outward directions (p, 3) in the world,
    pressures (p,) in Pa, and the radius (p,) of the share of each at rest, in world units.
    """

    places: Array
    normals: Array
    pressures: Array
    radii: Array


@dataclass(frozen=True, eq=False)
class Reading:
    """Force (N, on the finger), depth (m) and places of a finger, world coordinates (3,).

    ``contact`` lies on the drawn surface; ``force_vector`` has world axes. ``turn`` (3, 3)
    takes the tool's axes to the world's. ``area`` (m^2) and ``largest_pressure`` (Pa) are 0 for a
    point.
    """

    force: float
    depth: float
    touching: bool
    probe: Array
    contact: Array
    force_vector: Array
    turn: Array
    patch: Patch | None = None
    area: float = 0.0
    largest_pressure: float = 0.0


NOTHING = Reading(0.0, 0.0, False, np.zeros(3), np.zeros(3), np.zeros(3), np.eye(3))


def reading(session: PressSession) -> Reading:
    """Reading of the first finger."""
    return readings(session)[0]


# By session: what the readings are of, and they. Panel and views ask several times a frame.
_latest: WeakKeyDictionary[PressSession, tuple[tuple[object, ...], tuple[Reading, ...]]] = (
    WeakKeyDictionary()
)


def readings(session: PressSession) -> tuple[Reading, ...]:
    """Readings of all fingers from the latest snapshot; none before the first, and while the
    device is disconnected.
    """
    if session.snapshot is None or session.state.phase is Phase.LOST:
        return (NOTHING,) * len(session.leads)
    # Compared by identity: each tick has its own.
    now = (session.snapshot, session.drawn, session.seen.displacements, *session.places)
    before, known = _latest.get(session, ((), ()))
    if len(before) != len(now) or any(a is not b for a, b in zip(before, now, strict=True)):
        known = _readings(session)
        _latest[session] = now, known
    return known


def _readings(session: PressSession) -> tuple[Reading, ...]:
    snapshot = session.snapshot
    if snapshot is None:
        return ()
    fingers = zip(snapshot.fingers, session.frames, strict=True)
    tool = session.tip.tool
    if tool is None:
        return tuple(_of_point(session, *one) for one in fingers)
    return tuple(_of_tool(session, *one, tool) for one in fingers)


def _of_point(session: PressSession, finger: FingerSnapshot, frame: BodyFrame) -> Reading:
    turn = np.eye(3)
    probe, proxy = np.asarray(finger.probe), np.asarray(finger.proxy)
    if not finger.touching:
        place = frame.world_from_body(probe)
        return Reading(0.0, 0.0, False, place, place, np.zeros(3), turn)
    contact = proxy
    if session.seen.displacements is not None:
        corners = session.drawn.body.mesh.surface_nodes[np.asarray(finger.triangle)]
        moved = session.drawn.node_displacements(session.seen.displacements)[corners]
        contact = proxy + np.asarray(finger.alpha) @ moved
    force = _force(finger)
    return Reading(
        force=float(np.linalg.norm(force)),
        depth=_depth(session, finger),
        touching=True,
        probe=frame.world_from_body(probe),
        contact=frame.world_from_body(contact),
        force_vector=frame.turn_to_world(force),
        turn=turn,
    )


def _of_tool(
    session: PressSession, finger: FingerSnapshot, frame: BodyFrame, tool: Tool
) -> Reading:
    rotation = np.asarray(finger.orientation)
    probe, turn = frame.world_from_body(np.asarray(finger.probe)), frame.rotation @ rotation
    pressures = np.asarray(finger.pressures)
    if not finger.touching or not np.any(pressures > 0.0):
        return Reading(0.0, 0.0, False, probe, probe, np.zeros(3), turn)
    force, pushes = _force(finger), np.asarray(finger.point_forces)
    carries = pressures > 0.0
    sizes = np.linalg.norm(pushes[carries], axis=1)
    radii = np.sqrt(sizes / pressures[carries] / np.pi) / frame.metres_per_unit
    points = _as_drawn(session, finger, np.asarray(finger.points)[carries])
    places = frame.world_from_body(points)
    outward = frame.turn_to_world(-pushes[carries] / sizes[:, None])
    return Reading(
        force=float(np.linalg.norm(force)),
        depth=_depth(session, finger),
        touching=True,
        probe=probe,
        contact=sizes @ places / sizes.sum(),
        force_vector=frame.turn_to_world(force),
        turn=turn,
        patch=Patch(places, outward, pressures[carries], radii),
        area=float((sizes / pressures[carries]).sum()),
        largest_pressure=float(pressures.max()),
    )


def _as_drawn(session: PressSession, finger: FingerSnapshot, points: Array) -> Array:
    """Points (p, 3) of the linear shape mapped to the drawn one."""
    if session.seen.displacements is None or session.seen.linear is None or not len(finger.nodes):
        return points
    mesh, drawn = session.drawn.body.mesh, session.drawn
    nodes = mesh.surface_nodes[np.asarray(finger.nodes)]
    linear = drawn.node_displacements(session.seen.linear)[nodes]
    beyond = drawn.node_displacements(session.seen.displacements)[nodes] - linear
    if not beyond.any():
        return points
    # Weighted by distance, for a smooth map.
    away = np.linalg.norm(points[:, None] - (mesh.nodes[nodes] + linear), axis=2)
    nearness = 1.0 / (away + 1e-3 * drawn.size) ** 2
    moved: Array = points + nearness @ beyond / nearness.sum(axis=1, keepdims=True)
    return moved


def _depth(session: PressSession, finger: FingerSnapshot) -> float:
    mesh = session.drawn.body.mesh
    return finger_depth(mesh, session.tip.tool, finger, session.seen.displacements)


def _force(finger: FingerSnapshot) -> Array:
    # A limp device has no force at any depth.
    return np.zeros(3) if finger.state == "disabled" else np.asarray(finger.contact_force)
