"""Tools that a body is kept out of while it comes to rest.

The linear contact tells forces, under which a body of another law goes elsewhere: beside a tool it
would be drawn within it or apart. Here it presses where it touches and lets go where it does not
(`native/src/solid/load/against.rs`), in three places of each triangle that the tools may meet. A
body that nothing holds rough tools hold aside, too (:mod:`.held_aside`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ....body.imprinted_body import ImprintedBody, as_touched
from ....body.soft_body import SoftBody
from ....contact.near_field.contact_points import ContactPoints
from ....contact.near_field.surface_shape import face_areas, face_normals
from ....contact.tool.native_tool import native_shape
from ...solid.free_solid import FreeSolid
from ..finger_load import FingerLoad, Setting, on_free_nodes
from ..lying import Loose
from ..relaxation import Relaxation, fields_of
from .held_aside import held_aside, pushed_and_pulled

Array = NDArray[np.float64]

# Places of a triangle, each for a third of its area.
PLACES = np.array([[4.0, 1.0, 1.0], [1.0, 4.0, 1.0], [1.0, 1.0, 4.0]]) / 6.0
# Pressure over depth where a place is within a tool, times the mean edge, per pascal.
FIRMNESS = 30.0
# What lies within so many edges of a tool at rest may meet it.
MARGIN_EDGES = 2.0
# Triangles at most: the compliance of what presses is factored again and again.
MOST_TRIANGLES = 2000
# What is missed as a share of the work, and steps.
CLOSE, MOST_STEPS = 0.002, 120

_places: WeakKeyDictionary[SoftBody, ContactPoints] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class Kept:
    """A body beside tools, at unit modulus.

    Attributes
    ----------
    linear : (f, 3), the linear displacements that are warped to it.
    displacements : (f, 3) of the free nodes, metres.
    forces : (k, 3) on the body, of each tool.
    pressing : on how many places the least of them does; fewer where few carry most of it.
    near, pushes : places (p,) of each that may meet it, and the forces (p, 3) on all of these.
    left : what is not at rest or still within, as a share of the work.
    steps : that it took.
    """

    linear: Array
    displacements: Array
    forces: Array
    pressing: float
    near: Sequence[NDArray[np.int64]]
    pushes: Array
    left: float
    steps: int


def places_of(body: SoftBody) -> ContactPoints:
    """All places (3 t,) of a surface of t triangles, where contact meets it; kept with the body."""
    if body not in _places:
        _places[body] = _all_places(body)
    return _places[body]


def _all_places(body: SoftBody) -> ContactPoints:
    mesh = body.mesh
    at_rest = body.at_rest if isinstance(body, ImprintedBody) else body
    triangles = np.repeat(np.arange(len(mesh.surface_triangles)), 3)
    alphas = np.tile(PLACES, (len(mesh.surface_triangles), 1))
    corners = at_rest.mesh.nodes[mesh.surface_triangles[triangles]]
    return ContactPoints(
        as_touched(body, np.einsum("pa,pai->pi", alphas, corners)),
        face_normals(mesh)[triangles],
        triangles,
        alphas,
        face_areas(mesh)[triangles] / 3.0,
    )


def kept_out(
    body: SoftBody,
    solid: FreeSolid,
    relaxation: Relaxation,
    loads: Sequence[FingerLoad],
    start: Array,
    loose: Loose | None = None,
    firmness: float = 1.0,
    before: Kept | None = None,
) -> Kept | None:
    """The body beside the tools of ``loads``; None where they are none or meet too much.

    ``start``: linear displacements (f, 3) to begin from. ``loose``: how it goes as a whole between
    them, and so many times its dead loads press it beside; ``before``: of a loose body, beside the
    same tools hardly elsewhere, from where it goes on.
    """
    whole = [(load, load.by) for load in loads if load.by is not None]
    if len(whole) < len(loads):
        return None
    near = [_near(load, by) for load, by in whole]
    count = sum(map(len, near))
    if not 0 < count <= 3 * MOST_TRIANGLES:
        return None
    places = [places_of(by.body).taken(one) for (_, by), one in zip(whole, near, strict=True)]
    which = np.repeat(np.arange(len(near)), [len(one) for one in near])
    triangles, alphas, rests, areas = (
        np.concatenate([getattr(one, name) for one in places])
        for name in ("triangles", "alphas", "positions", "areas")
    )
    mesh = body.mesh
    corners = mesh.surface_triangles[triangles]
    free = np.searchsorted(solid.free, corners)
    free[free == solid.node_count] = 0
    moves = solid.free[free] == corners
    free, shares = np.where(moves, free, 0), np.where(moves, alphas, 0.0)
    seen, known = np.unique(corners, return_inverse=True)
    local = np.searchsorted(mesh.surface_nodes, seen)
    compliance = body.surface_blocks(local, local)
    if loose is not None:
        compliance = compliance + loose.compliance(np.searchsorted(solid.free, seen))
    linear, moved, pushes, left, steps = relaxation.native.kept_out(
        start if before is None else before.linear,
        [(native_shape(by.tool), by.pose.position, by.pose.rotation) for _, by in whole],
        (
            free.ravel(),
            known.ravel(),
            shares,
            rests,
            FIRMNESS / usual_edge(body) * areas,
            which,
        ),
        compliance.reshape(-1, 3, 3),
        float((on_free_nodes(solid, loads) * start).sum()),
        CLOSE,
        MOST_STEPS,
        None if loose is None else firmness * loose.dead,
        None if loose is None else (*fields_of(loose.motions), loose.gives.tolist()),
        None if loose is None else _held_by(whole, places, free, shares, start, near, before),
    )
    forces = np.zeros((len(whole), 3))
    np.add.at(forces, which, pushes)
    pressing = min(carrying(pushes[which == one]) for one in range(len(whole)))
    return Kept(linear, moved, forces, pressing, near, pushes, left, steps)


def carrying(forces: Array) -> float:
    """On how many of (k, 3) places forces are; fewer where few carry most of them."""
    sizes = np.linalg.norm(forces, axis=1)
    return float(sizes.sum() ** 2 / max((sizes * sizes).sum(), np.finfo(float).tiny))


def _held_by(
    whole: Sequence[tuple[FingerLoad, Setting]],
    places: Sequence[ContactPoints],
    free: NDArray[np.int64],
    shares: Array,
    moved: Array,
    near: Sequence[NDArray[np.int64]],
    before: Kept | None,
) -> tuple[Array, Array, Array, Array, Array]:
    ends = np.cumsum([len(one.triangles) for one in places])[:-1]
    parts = zip(whole, places, np.split(free, ends), np.split(shares, ends), strict=True)
    every = [
        held_aside(load, by, own, corners, alphas, moved, usual_edge(by.body))
        for (load, by), own, corners, alphas in parts
    ]
    goals, normals, friction, pushes, pulls = (
        np.concatenate([getattr(one, name) for one in every])
        for name in ("goals", "normals", "friction", "pushes", "pulls")
    )
    if before is not None:
        forces = _on_places(near, before)
        pushes, pulls = pushed_and_pulled(forces, normals)
        # Of smooth tools no normals are told, and all that they do is to push.
        smooth = friction == 0.0
        pushes[smooth], pulls[smooth] = np.linalg.norm(forces[smooth], axis=1), 0.0
    return goals, normals, friction, pushes, pulls


def _on_places(near: Sequence[NDArray[np.int64]], before: Kept) -> Array:
    """The forces (p, 3) that places were under, in the order of now; none on those that are new."""
    ends = np.cumsum([len(one) for one in before.near])[:-1]
    found = []
    for now, known, pushes in zip(near, before.near, np.split(before.pushes, ends), strict=True):
        _, here, there = np.intersect1d(now, known, assume_unique=True, return_indices=True)
        forces = np.zeros((len(now), 3))
        forces[here] = pushes[there]
        found.append(forces)
    return np.concatenate(found)


def _near(load: FingerLoad, by: Setting) -> NDArray[np.int64]:
    """Places (p,) of free triangles that face a tool and may meet it."""
    mesh, places = by.body.mesh, places_of(by.body)
    distance, _ = by.tool.distance(by.pose.to_tool(places.positions))
    facing = places.normals @ load.forces.sum(axis=0) < 0.0
    free = ~np.isin(mesh.surface_triangles[places.triangles], by.body.fixed)
    return np.flatnonzero(
        facing & free.any(axis=1) & (distance < MARGIN_EDGES * usual_edge(by.body))
    )


def usual_edge(body: SoftBody) -> float:
    """Of a usual triangle of the surface, metres."""
    return float(np.sqrt(2.0 * np.median(face_areas(body.mesh))))
