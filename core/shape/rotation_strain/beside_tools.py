"""Presses by tools that slide: what is drawn and what is felt come from one contact.

The firmness is its force over that of the linear contact. Where a touch is hardly wider than a
triangle, its places lack what the near field knows, and between them the dent is deeper than the
tool: it is trusted as far as many of them press.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...contact.press import ContactSettings, Press
from ...contact.tool.pose import Pose
from ...contact.touches import ToolTouch
from ...errors import PalpateError
from ..solid.free_solid import FreeSolid
from .finger_load import FingerLoad, Setting, on_free_nodes, totals
from .kept_out import Kept, kept_out, places_of
from .lying import Loose
from .relaxation import Relaxation

Array = NDArray[np.float64]

# What steps may leave, as a share of the work, where the body counts as at rest.
ENOUGH = 0.015
# With so few places that press it is not trusted, with so many it is.
FEW_PLACES, MANY_PLACES = 8.0, 16.0


@dataclass(frozen=True, eq=False)
class Beside:
    """A body at rest beside its tools.

    Attributes
    ----------
    share : of the linear force, by which it presses back.
    trust : 0 to 1, how far its touch is wider than the triangles.
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
    kept = kept_out(body, solid, relaxation, linear, moved if start is None else start)
    if kept is None or kept.left > ENOUGH:
        return None
    return _beside(linear, kept, 0.5 * float((forces * moved).sum()))


def between_tools(
    body: SoftBody,
    solid: FreeSolid,
    relaxation: Relaxation,
    loads: Sequence[FingerLoad],
) -> Beside | None:
    """A body that nothing holds where the tools of ``loads`` are, what bears it among them.

    Its weight is as under the linear contact, as many times as the body was firm there. None as of
    :func:`beside_tools`.
    """
    if solid.motions is None or any(load.by is None for load in loads):
        return None
    forces = on_free_nodes(solid, loads)
    moved = solid.linear(forces)
    loose, firmness = Loose.of(solid, solid.motions, loads), loads[0].firmness
    kept = kept_out(body, solid, relaxation, loads, moved, loose, firmness)
    if kept is None or kept.left > ENOUGH:
        return None
    energy = 0.5 * float((forces * moved).sum())
    return _beside(loads, kept, energy)


def _beside(loads: Sequence[FingerLoad], kept: Kept, energy: float) -> Beside | None:
    trust = min((kept.pressing - FEW_PLACES) / (MANY_PLACES - FEW_PLACES), 1.0)
    if trust <= 0.0:
        return None
    along = totals(loads)
    share = float((kept.forces * along).sum()) / float((along * along).sum())
    return Beside(share, trust, energy, kept)


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
