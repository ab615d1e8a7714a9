"""Press by the simulated device while Blender draws: hand script, frames at 60 Hz, samples."""

import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from frame_clock import frames
from installed import palpate
from numpy.typing import NDArray

Array = NDArray[np.float64]

SECONDS = 8.0
# Times and depths of the hand, as shares of the full depth; the last value is held until the end.
PRESSES = [(0.6, -0.5), (1.0, 0.0), (2.2, 1.0), (2.6, 1.0), (3.6, -0.1), (4.4, 0.7), (5.2, 0.2),
           (6.4, 1.0)]  # fmt: skip


@dataclass(frozen=True)
class Place:
    """Place to press: a point of the surface and the direction inwards, body coordinates."""

    point: Array
    inward: Array


def place_near(thing: bpy.types.Object, near: Array) -> Place:
    """Free surface node nearest to `near`, with the inward direction."""
    body = palpate("operators.object.body_store").load(thing)
    mesh = body.mesh
    free = body.compliance.free_surface
    node = free[np.argmin(np.linalg.norm(mesh.nodes[free] - near, axis=1))]
    ring = mesh.surface_triangles[(mesh.surface_triangles == node).any(axis=1)]
    a, b, c = (mesh.nodes[ring[:, corner]] for corner in range(3))
    inward = -np.cross(b - a, c - a).sum(axis=0)
    return Place(mesh.nodes[node], inward / np.linalg.norm(inward))


def write_hand(path: Path, place: Place, depth: float) -> None:
    """Write keyframes of the simulated hand: presses of up to `depth` metres, the last one held."""
    start = place.point - 0.02 * place.inward
    keys = [[0.0, *start.tolist()]]
    keys += [[t, *(place.point + share * depth * place.inward).tolist()] for t, share in PRESSES]
    path.write_text(json.dumps({"keyframes": keys, "repeat_from": None}), encoding="utf-8")


def press_with_device(
    thing: bpy.types.Object, place: Place, depth: float, folder: Path
) -> tuple[dict[str, Any], NDArray[np.void]]:
    """Press by the simulated device for SECONDS while drawing; keep the last shape.

    Returns figures and the servo's samples of every tick.
    """
    session_module, state = (
        palpate("operators.session.press_session"),
        palpate("operators.session.press_state"),
    )
    simulated = palpate("simulated.simulated_process")
    options = palpate("simulated.hand.options")
    hand = folder / "hand.json"
    write_hand(hand, place, depth)
    scene = bpy.context.scene
    device = simulated.SimulatedDevice(
        options.SimulatedOptions(script=str(hand)),
        python=sys.executable,
        python_args=bpy.app.python_args,
    )
    with device:
        # The paper's finger, whose depth is from the probe to its proxy.
        scene.palpate.tip = "POINT"
        scene.palpate.source, scene.palpate.port = "SERIAL", device.port
        session = session_module.begin(thing, scene, state.Source.DEVICE)
        try:
            drawn, samples = _draw_frames(session)
            figures = _figures(session, thing, drawn)
            session.post(state.Keep())
        finally:
            session_module.give_way("")
    figures["device"] = device.stop()
    return figures, samples


def _draw_frames(session: Any) -> tuple[Array, NDArray[np.void]]:
    """Tick the session in every frame; times of frames that drew a dent, seconds."""
    seconds, samples = [], [session.loop.servo.samples()]
    for begun in frames(SECONDS, lambda: _is_pressed(session) and _is_felt(session)):
        session.tick()
        if session.seen.displacements is not None:
            seconds.append(time.perf_counter() - begun)
        samples.append(session.loop.servo.samples())
    return np.array(seconds), np.concatenate(samples)


def _is_pressed(session: Any) -> bool:
    return session.seen.displacements is not None and bool(session.state.pressed)


def _is_felt(session: Any) -> bool:
    """Whether the force has come back after the device was let go."""
    snapshot = session.snapshot
    wanted, output = snapshot.contact_force, snapshot.output_force
    return bool(np.linalg.norm(output) > 0.9 * np.linalg.norm(wanted))


def _figures(session: Any, thing: bpy.types.Object, drawn: Array) -> dict[str, Any]:
    snapshot, moved = session.snapshot, session.seen.displacements
    if not _is_pressed(session):
        reason = session.state.message or "nothing is touched"
        raise RuntimeError(f"the hand holds, but there is no press to keep: {reason}")
    frame = session.frames[0]
    return {
        "servo": session.loop.servo.counters(),
        "press": {
            "object": thing.name,
            "depth_mm": 1e3 * float(np.linalg.norm(snapshot.probe - snapshot.proxy)),
            "force_n": float(np.linalg.norm(snapshot.output_force)),
            "max_displacement_mm": 1e3 * float(np.linalg.norm(moved, axis=1).max()),
            "frames": len(drawn),
            "frame_ms": {
                "p50": 1e3 * float(np.percentile(drawn, 50)),
                "p99": 1e3 * float(np.percentile(drawn, 99)),
            },
        },
        "contact": {
            "proxy": frame.world_from_body(snapshot.proxy).tolist(),
            "probe": frame.world_from_body(snapshot.probe).tolist(),
            "force": frame.turn_to_world(snapshot.output_force).tolist(),
        },
    }
