"""Tools that a body is kept out of while it comes to rest: contact without friction.

The linear contact tells forces, under which a body of another law goes elsewhere: beside a tool it
would be drawn within it or apart. Here it presses where it touches and lets go where it does not
(`native/src/solid/load/against.rs`), in three places of each triangle that the tools may meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...contact.tool.native_tool import native_shape
from ..solid.free_solid import FreeSolid
from .finger_load import FingerLoad, Setting
from .relaxation import Relaxation

Array = NDArray[np.float64]

# Places of a triangle, each for a third of its area.
PLACES = np.array([[4.0, 1.0, 1.0], [1.0, 4.0, 1.0], [1.0, 1.0, 4.0]]) / 6.0
# Pressure over depth where a place is within a tool, times the mean edge, per pascal.
FIRMNESS = 30.0
# What lies within so many edges of a tool at rest may meet it.
MARGIN_EDGES = 2.0
# Triangles at most: their places' compliance is factored again and again.
MOST_TRIANGLES = 1000
# What is missed as a share of the work, and steps.
CLOSE, MOST_STEPS = 0.002, 120


@dataclass(frozen=True, eq=False)
class Kept:
    """A body beside tools, at unit modulus.

    Attributes
    ----------
    displacements : (f, 3) of the free nodes, metres.
    force : (3,) on the body, all of it.
    left : what is not at rest or still within, as a share of the work.
    steps : that it took.
    """

    displacements: Array
    force: Array
    left: float
    steps: int


def kept_out(
    body: SoftBody,
    solid: FreeSolid,
    relaxation: Relaxation,
    loads: Sequence[FingerLoad],
    start: Array,
) -> Kept | None:
    """The body beside the tools of ``loads``; None where they are none or meet too much.

    ``start``: linear displacements (f, 3) to begin from.
    """
    whole = [(load, load.by) for load in loads if load.by is not None]
    if len(whole) < len(loads):
        return None
    near = [_near(body, load, by) for load, by in whole]
    if not 0 < sum(map(len, near)) <= MOST_TRIANGLES:
        return None
    mesh = body.mesh
    which = np.repeat(np.arange(len(near)), [3 * len(one) for one in near])
    corners = np.repeat(mesh.surface_triangles[np.concatenate(near)], 3, axis=0)
    alphas = np.tile(PLACES, (len(corners) // 3, 1))
    rests = np.einsum("pa,pai->pi", alphas, mesh.nodes[corners])
    places = np.searchsorted(solid.free, corners)
    places[places == solid.node_count] = 0
    moves = solid.free[places] == corners
    seen, known = np.unique(corners, return_inverse=True)
    local = np.searchsorted(mesh.surface_nodes, seen)
    edge, areas = _edge_and_areas(mesh.nodes[corners])
    moved, pushes, left, steps = relaxation.native.kept_out(
        start,
        [(native_shape(by.tool), by.pose.position, by.pose.rotation) for _, by in whole],
        (
            np.where(moves, places, 0).ravel(),
            known.ravel(),
            np.where(moves, alphas, 0.0),
            rests,
            FIRMNESS / edge * areas / 3.0,
            which,
        ),
        body.surface_blocks(local, local).reshape(-1, 3, 3),
        _work(solid, loads, start),
        CLOSE,
        MOST_STEPS,
    )
    return Kept(moved, pushes.sum(axis=0), left, steps)


def _near(body: SoftBody, load: FingerLoad, by: Setting) -> NDArray[np.int64]:
    """Triangles (t,) that face a tool and may meet it."""
    corners = body.mesh.nodes[body.mesh.surface_triangles]
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = crosses @ load.forces.sum(axis=0) < 0.0
    edge, _ = _edge_and_areas(corners)
    middles = (corners.mean(axis=1) - by.pose.position) @ by.pose.rotation
    distance, _ = by.tool.distance(middles)
    free = ~np.isin(body.mesh.surface_triangles, body.fixed).all(axis=1)
    return np.flatnonzero(facing & free & (distance < MARGIN_EDGES * edge))


def _work(solid: FreeSolid, loads: Sequence[FingerLoad], moved: Array) -> float:
    """Of the loads on displacements (f, 3), J/Pa."""
    nodes = np.concatenate([load.nodes for load in loads])
    forces = np.concatenate([load.forces for load in loads])
    return float((solid.on_free_nodes(nodes, forces) * moved).sum())


def _edge_and_areas(corners: Array) -> tuple[float, Array]:
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas: Array = 0.5 * np.linalg.norm(crosses, axis=1)
    return float(np.sqrt(2.0 * np.median(areas))), areas
