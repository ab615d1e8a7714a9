"""Friction of rough tools: places of a body that stick are held where the linear contact has them.

A linear body whose foot sticks on a rough floor is held there by forces that say nothing of how its
law would go aside: its own friction is what it takes to stay there. So a place is held at where it
is in the linear contact, by no more than friction times what presses it
(`native/src/solid/load/hold.rs`). One that slides there has come from where friction points to, and
is held back to there: so it is by all that friction gives.

A linear foot slides a little under each stride of a tool, one of a law less: on what is flat a foot
is held where it was set down, moved and turned as a whole as the linear one has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from ....body.soft_body import SoftBody
from ....contact.near_field.contact_points import ContactPoints
from ..finger_load import FingerLoad, Footing, Setting

Array = NDArray[np.float64]

# From this share of what friction gives a place is taken for one that slides, little by little.
SLIDES_FROM = 0.9
# How far it has come, over the edge of a usual triangle.
CAME = 0.25
# A tool is flat where what it pushes with adds up to more than this share of all pushes, little by
# little.
FLAT_FROM = 0.98
# Over how many edges a node's force is spread.
SPREAD = 1.0
# Places that are less apart than this share of the edge count alike.
NEAREST = 0.25


@dataclass(frozen=True, eq=False)
class HeldAside:
    """How p places are held.

    Attributes
    ----------
    goals : (p, 3), the displacements that they are held at, metres.
    normals : (p, 3), of the tools there, outward.
    friction : (p,), Coulomb's coefficients; none of smooth tools.
    pushes, pulls : (p,) and (p, 3), what tools press there and hold aside by the linear contact, N
        at 1 Pa.
    """

    goals: Array
    normals: Array
    friction: Array
    pushes: Array
    pulls: Array


def held_aside(
    load: FingerLoad,
    by: Setting,
    places: ContactPoints,
    corners: NDArray[np.int64],
    alphas: Array,
    moved: Array,
    edge: float,
) -> HeldAside:
    """How the tool of a load holds places (p,).

    Parameters
    ----------
    corners : (p, 3), their free nodes.
    alphas : (p, 3), their area coordinates; none of what does not move.
    moved : (f, 3), the linear displacements under all loads.
    edge : of a usual triangle, metres.
    """
    goals = np.einsum("pa,pai->pi", alphas, moved[corners])
    if load.friction == 0.0:
        none = np.zeros(len(goals))
        return HeldAside(goals, np.zeros_like(goals), none, none, np.zeros_like(goals))
    if by.footing is not None and by.footing.pushes.any():
        goals = between(by.footing, places.positions, edge)
    _, out = by.tool.distance(by.pose.to_tool(places.positions + goals))
    normals = out @ by.pose.rotation.T
    forces = load.firmness * _spread(load, by.body, places, edge)
    pushes, pulls = pushed_and_pulled(forces, normals)
    sizes = np.maximum(np.linalg.norm(pulls, axis=1), np.finfo(float).tiny)
    came = CAME * edge * sliding(forces, normals, load.friction)
    back = (came / sizes)[:, None] * pulls
    goals = _as_a_whole(goals + back, places.positions, normals, pushes)
    return HeldAside(goals, normals, np.full(len(goals), load.friction), pushes, pulls)


def _as_a_whole(goals: Array, at: Array, normals: Array, pushes: Array) -> Array:
    """Goals (p, 3) of places ``at`` (p, 3) of a foot, aside those of its motion as a whole where a
    tool of such normals is flat.
    """
    total = pushes.sum()
    if total == 0.0:
        return goals
    shares = pushes / total
    normal = shares @ normals
    flatness = float(np.linalg.norm(normal))
    normal = normal / max(flatness, np.finfo(float).tiny)
    from_middle, beyond = at - shares @ at, goals - shares @ goals
    arms = np.cross(normal, from_middle)
    width = float(shares @ (arms * arms).sum(axis=1))
    turn = float(shares @ (arms * beyond).sum(axis=1)) / max(width, np.finfo(float).tiny)
    change = turn * arms - beyond
    change -= np.einsum("pi,pi->p", change, normals)[:, None] * normals
    share = np.clip((flatness - FLAT_FROM) / (1.0 - FLAT_FROM), 0.0, 1.0)
    found: Array = goals + share * change
    return found


def pushed_and_pulled(forces: Array, normals: Array) -> tuple[Array, Array]:
    """How much forces (p, 3) push along normals, (p,), and what they pull aside, (p, 3)."""
    along = np.einsum("pi,pi->p", forces, normals)
    return np.maximum(along, 0.0), forces - along[:, None] * normals


def between(footing: Footing, at: Array, edge: float) -> Array:
    """How far places ``at`` (p, 3), at rest, have gone among those that are pressed, (p, 3): the
    mean of these, the nearest first; continuous as they come and go.
    """
    apart = cdist(at, footing.at_rest, "sqeuclidean")
    weights = footing.pushes / np.square(apart + (NEAREST * edge) ** 2)
    found: Array = weights @ footing.moved / weights.sum(axis=1)[:, None]
    return found


def sliding(forces: Array, normals: Array, friction: float) -> Array:
    """How far places under forces (p, 3) by tools with such normals slide, 0 to 1, (p,)."""
    pushes, pulls = pushed_and_pulled(forces, normals)
    aside, most = np.linalg.norm(pulls, axis=1), friction * pushes
    share = np.ones(len(forces))
    np.divide(aside, most, out=share, where=most > 0.0)
    found: Array = np.clip((share - SLIDES_FROM) / (1.0 - SLIDES_FROM), 0.0, 1.0)
    return found


def _spread(load: FingerLoad, body: SoftBody, places: ContactPoints, edge: float) -> Array:
    """The forces of a load, each spread over the places (p,) around its node, (p, 3)."""
    apart = cdist(places.positions, body.mesh.nodes[load.nodes], "sqeuclidean")
    weights = places.areas[:, None] / np.square(apart + (SPREAD * edge) ** 2)
    found: Array = weights @ (load.forces / weights.sum(axis=0)[:, None])
    return found
