"""What a press measures now, in numbers for panel and HUD."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..operators.press_session import PressSession
from ..operators.press_state import Phase

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Reading:
    """Force (N, on the finger), depth (m), and where it happens, world coordinates (3,).

    ``contact`` lies on the surface as it is seen; ``force_vector`` has world axes.
    """

    force: float
    depth: float
    touching: bool
    probe: Array
    contact: Array
    force_vector: Array


NOTHING = Reading(0.0, 0.0, False, np.zeros(3), np.zeros(3), np.zeros(3))


def reading(session: PressSession) -> Reading:
    """What the newest snapshot says; nothing before the first, and while the device is away."""
    snapshot = session.snapshot
    if snapshot is None or session.state.phase is Phase.LOST:
        return NOTHING
    frame = session.drawn.frame
    probe, proxy = np.asarray(snapshot.probe), np.asarray(snapshot.proxy)
    if not snapshot.touching:
        place = frame.world_from_body(probe)
        return Reading(0.0, 0.0, False, place, place, np.zeros(3))
    body = session.drawn.body
    contact = proxy
    if session.displacements is not None:
        corners = body.mesh.surface_nodes[np.asarray(snapshot.triangle)]
        moved = session.drawn.node_displacements(session.displacements)[corners]
        contact = proxy + np.asarray(snapshot.alpha) @ moved
    # A limp device gives nothing, however deep it is.
    limp = snapshot.state == "disabled"
    force = np.zeros(3) if limp else np.asarray(snapshot.contact_force)
    return Reading(
        force=float(np.linalg.norm(force)),
        depth=float(np.linalg.norm(probe - proxy)),
        touching=True,
        probe=frame.world_from_body(probe),
        contact=frame.world_from_body(contact),
        force_vector=frame.turn_to_world(force),
    )
