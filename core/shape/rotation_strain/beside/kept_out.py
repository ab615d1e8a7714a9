"""Tools that a body is kept out of while it comes to rest.

The linear contact tells forces, under which a body of another law goes elsewhere: beside a tool it
would be drawn within it or apart. Here it presses where it touches and lets go where it does not
(`native/src/solid/load/against.rs`), in the places that the tools reach. A body that nothing holds
rough tools hold aside, too (:mod:`.held_aside`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....contact.tool.native_tool import native_shape
from ...solid.free_solid import FreeSolid
from ..finger_load import FingerLoad, on_free_nodes
from ..lying import Loose
from ..relaxation import Relaxation, fields_of
from .held_aside import held_aside, pushed_and_pulled
from .reached import Reached, usual_edge

Array = NDArray[np.float64]

# What is missed as a share of the work, and steps.
CLOSE, MOST_STEPS = 0.002, 120
# What is left of one that went astray.
ASTRAY = 1.0
# Times as firm as what holds places off, where they give on springs instead.
STIFF = 10.0


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


def kept_out(
    solid: FreeSolid,
    relaxation: Relaxation,
    reached: Reached,
    loads: Sequence[FingerLoad],
    moved: Array,
    begin: Array,
    loose: Loose | None = None,
    firmness: float = 1.0,
    before: Kept | None = None,
) -> Kept:
    """The body beside the tools of ``loads`` at the places that they reach; on stiff springs where
    what is counted in goes to and fro.

    ``moved``: displacements (f, 3) of a linear one under these loads; ``begin``: linear ones to
    begin from. ``loose``: how it goes as a whole between the tools, and so many times its dead
    loads press it beside; ``before``: of a loose body, under what its places were beside the same
    tools hardly elsewhere.
    """
    linear, there, pushes, left, steps = relaxation.native.kept_out(
        begin,
        [(native_shape(by.tool), by.pose.position, by.pose.rotation) for by in reached.tools],
        (
            reached.free.ravel(),
            reached.known.ravel(),
            reached.shares,
            reached.rests,
            reached.firmness,
            reached.which,
        ),
        reached.compliance.reshape(-1, 3, 3),
        float((on_free_nodes(solid, loads) * begin).sum()),
        CLOSE,
        MOST_STEPS,
        None if loose is None else firmness * loose.dead,
        None if loose is None else (*fields_of(loose.motions), loose.gives.tolist()),
        None if loose is None else _held_by(loads, reached, moved, before),
        gives=reached.gives,
    )
    forces = reached.of_tools(pushes)
    pressing = min(carrying(pushes[reached.which == one]) for one in range(len(forces)))
    kept = Kept(linear, there, forces, pressing, reached.near, pushes, left, steps)
    if reached.gives or left <= CLOSE:
        return kept
    if left < ASTRAY:
        begin, before = linear, kept
    sprung = reached.on_springs(STIFF)
    return kept_out(solid, relaxation, sprung, loads, moved, begin, loose, firmness, before)


def carrying(forces: Array) -> float:
    """On how many of (k, 3) places forces are; fewer where few carry most of them."""
    sizes = np.linalg.norm(forces, axis=1)
    return float(sizes.sum() ** 2 / max((sizes * sizes).sum(), np.finfo(float).tiny))


def _held_by(
    loads: Sequence[FingerLoad], reached: Reached, moved: Array, before: Kept | None
) -> tuple[Array, Array, Array, Array, Array]:
    ends = np.cumsum([len(one) for one in reached.near])[:-1]
    corners, shares = np.split(reached.free, ends), np.split(reached.shares, ends)
    parts = zip(loads, reached.tools, reached.places, corners, shares, strict=True)
    every = [
        held_aside(load, by, own, nodes, alphas, moved, usual_edge(by.body))
        for load, by, own, nodes, alphas in parts
    ]
    goals, normals, friction, pushes, pulls = (
        np.concatenate([getattr(one, name) for one in every])
        for name in ("goals", "normals", "friction", "pushes", "pulls")
    )
    if before is not None:
        forces = _on_places(reached.near, before)
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
