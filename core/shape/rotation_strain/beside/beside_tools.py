"""Presses by tools that slide: what is drawn and what is felt come from one contact.

The firmness is its force over that of the linear contact. Where a touch is hardly wider than a
triangle, its places lack what the near field knows: there they lie on it as on a bed of springs. A
touch that is still finer they would miss.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ....body.soft_body import SoftBody
from ....contact.press import ContactSettings, Press
from ....contact.tool.pose import Pose
from ....contact.touches import ToolTouch
from ....errors import PalpateError
from ...solid.free_solid import FreeSolid
from ..finger_load import FingerLoad, Setting, on_free_nodes, totals
from ..lying import Loose
from ..relaxation import Relaxation
from .kept_out import Kept, carrying, kept_out
from .reached import Reached, places_of, usual_edge

Array = NDArray[np.float64]

# What steps may leave, as a share of the work, where the body counts as at rest.
ENOUGH = 0.015
# With so few places that would press a linear body a touch is hardly wider than triangles, with so
# many it is; of one that nothing holds, as many press it.
WIDE, WIDE_LYING = (12.0, 22.0), (8.0, 16.0)
# So much of the linear contact's force comes back from places that miss a touch, from others so
# much.
MISSED, RESOLVED = 0.6, 0.8
# Where a tool enters triangles between their places by so many edges more than in the linear
# contact, it goes through them little by little.
ENTERS = (0.02, 0.06)
# Of a linear body's force: with less a body has gone past its tool, or the tool through it.
SOFTEST = 0.1
# Places at most that press for each node that the linear contact presses.
PLACES_PER_NODE = 4.0


@dataclass(frozen=True, eq=False)
class Beside:
    """A body at rest beside its tools.

    Attributes
    ----------
    share : of the linear force, by which it presses back.
    trust : 0 to 1, how far its places tell of the touch; 0 where it is not at rest, or the tool
        not against it, too.
    energy : elastic, of the linear press, J/Pa.
    kept : it.
    """

    share: float
    trust: float
    energy: float
    kept: Kept


def beside_tools(
    body: SoftBody,
    solid: FreeSolid,
    relaxation: Relaxation,
    loads: Sequence[FingerLoad],
    depth: float,
    start: Array | None = None,
) -> Beside | None:
    """The body where tools are in by a share ``depth`` of what they are in under ``loads``.

    ``start``: linear displacements (f, 3) to begin from. None where a load is of no tool that
    slides, a touch is finer than the triangles, or the body does not come to rest.
    """
    there = _withdrawn(loads, depth)
    if there is None:
        return None
    linear = loads if depth == 1.0 else _pressed(there)
    if linear is None:
        return None
    forces = on_free_nodes(solid, linear)
    moved = solid.linear(forces)
    reached = Reached.of(body, solid, linear)
    if reached is None:
        return None
    begin, energy = moved if start is None else start, 0.5 * float((forces * moved).sum())

    along = totals(linear)

    def at(where: Reached, begin: Array, trust: float, told: Array) -> Beside:
        kept = kept_out(solid, relaxation, where, linear, moved, begin)
        return _beside(along, told, kept, energy, trust)

    narrow = 1.0 - _on_way(_pressing(reached, linear, moved), *WIDE)
    if not narrow:
        return _trusted(at(reached, begin, 1.0, along))
    bed = reached.on_bed(moved, along, narrow)
    if bed is None:
        return None
    comes_back = bed.of_tools(bed.pushes(moved))
    resolved = _on_way(_least_share(comes_back, along), MISSED, RESOLVED)
    if not resolved:
        return None
    # What these places miss of a linear body they miss of this one.
    told = along + narrow * (comes_back - along)
    linearly = reached.within(moved)

    def on(where: Reached, begin: Array) -> Beside | None:
        found = at(where, begin, resolved, told)
        enters = reached.within(found.kept.displacements) - linearly
        through = _on_way(enters / usual_edge(body), *ENTERS)
        return _trusted(replace(found, trust=found.trust * (1.0 - through)))

    found = on(bed, begin)
    # What is beneath is of the same law: as firm as the body was found to be.
    return found and on(bed.on_springs(found.share), found.kept.linear)


def _trusted(found: Beside) -> Beside | None:
    return found if found.trust > 0.0 else None


def _pressing(reached: Reached, loads: Sequence[FingerLoad], moved: Array) -> float:
    """On how many places the least of tools would press a linear body; no fewer than on nodes."""
    nodes = min(carrying(load.forces) for load in loads)
    if nodes >= WIDE[1]:
        return nodes
    pushes = reached.pushes(moved)
    return min(carrying(pushes[reached.which == one]) for one in range(len(reached.tools)))


def _least_share(told: Array, along: Array) -> float:
    """The share of the forces ``along`` (k, 3) that those ``told`` (k, 3) are, the least."""
    return float(((told * along).sum(axis=1) / (along * along).sum(axis=1)).min())


def between_tools(
    body: SoftBody,
    solid: FreeSolid,
    relaxation: Relaxation,
    loads: Sequence[FingerLoad],
    before: Kept | None = None,
) -> Beside | None:
    """A body that nothing holds where the tools of ``loads`` are, what bears it among them.

    Its weight is as under the linear contact, as many times as the body was firm there. ``before``:
    it beside the same tools, from where it goes on. None where a load is of no tool, where there is
    too much to meet, or where so few places were pressed before that they would not be trusted now.
    """
    if solid.motions is None or any(load.by is None for load in loads):
        return None
    if _is_fine(loads) or (before and before.pressing * _grown(before, loads) < WIDE_LYING[0]):
        return None
    forces = on_free_nodes(solid, loads)
    moved = solid.linear(forces)
    loose, firmness = Loose.of(solid, solid.motions, loads), loads[0].firmness
    reached = Reached.of(body, solid, loads, loose)
    if reached is None:
        return None
    begin = moved if before is None else before.linear
    kept = kept_out(solid, relaxation, reached, loads, moved, begin, loose, firmness, before)
    wide = _on_way(kept.pressing, *WIDE_LYING)
    along = totals(loads)
    return _beside(along, along, kept, 0.5 * float((forces * moved).sum()), wide)


def _beside(along: Array, told: Array, kept: Kept, energy: float, trust: float) -> Beside:
    """``along``: forces (k, 3) of the linear contact; ``told``: of its places on a linear body."""
    share = float((kept.forces * along).sum()) / float((told * along).sum())
    is_found = kept.left <= ENOUGH and share >= SOFTEST
    return Beside(share, trust if is_found else 0.0, energy, kept)


def _on_way(value: float, first: float, last: float) -> float:
    """How far it is from the first to the last."""
    return min(max((value - first) / (last - first), 0.0), 1.0)


def _is_fine(loads: Sequence[FingerLoad]) -> bool:
    """Whether the touch of a tool is so fine that its places would not be trusted."""
    nodes = min(carrying(load.forces) for load in loads)
    return PLACES_PER_NODE * nodes < WIDE_LYING[0]


def _grown(before: Kept, loads: Sequence[FingerLoad]) -> float:
    """How many times as much tools press as before, the one that presses most so."""
    now, then = (np.linalg.norm(forces, axis=1) for forces in (totals(loads), before.forces))
    return float((now / np.maximum(then, np.finfo(float).tiny)).max())


def _withdrawn(loads: Sequence[FingerLoad], depth: float) -> list[FingerLoad] | None:
    """The loads with each tool drawn back against the body's push on it."""
    found = []
    for load in loads:
        by, push = load.by, load.forces.sum(axis=0)
        if by is None or not push.any():
            return None
        distance, _ = by.tool.distance(by.pose.to_tool(places_of(by.body).positions))
        back = max(-float(distance.min()), 0.0) * (1.0 - depth)
        position = by.pose.position - back * push / np.linalg.norm(push)
        found.append(replace(load, by=replace(by, pose=Pose(position, by.pose.rotation))))
    return found


def _pressed(loads: Sequence[FingerLoad]) -> list[FingerLoad] | None:
    """The linear contact of these tools where they are; None where one of them does not touch."""
    settings: list[Setting] = [load.by for load in loads if load.by is not None]
    body = settings[0].body
    press = Press(body, [by.tool for by in settings], ContactSettings(1.0))
    try:
        touches = press.to([by.pose for by in settings])
    except PalpateError:
        return None
    made = [
        FingerLoad(touch.nodes, touch.nodal_forces, False, by)
        for touch, by in zip(touches, settings, strict=True)
        if isinstance(touch, ToolTouch) and len(touch.nodes)
    ]
    return made if len(made) == len(loads) else None
