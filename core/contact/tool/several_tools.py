"""Several tools on one body: each feels the others through it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ..near_field.compliance_beneath import point_compliance
from ..near_field.contact_points import ContactPoints
from .tool_candidates import looked_at, moved_by, points_entered
from .tool_contact import MOST_ADDITIONS, continued, has_lost, press_tool, touch_of
from .tool_law import Candidates, Settled, along_normals, settle_together
from .tool_touch import Load, ToolTouch
from .tool_way import MOST_STRIDES, is_outside, stride, too_far
from .tools import Pose, Tool

# Eigenvalues of the compliance below this share of the largest, if negative, are rounding.
ROUNDING = 1e-6


def press_tools(
    body: SoftBody,
    tools: Sequence[tuple[Tool, Pose]],
    *,
    young_modulus: float | None = None,
    start: Sequence[ToolTouch] | None = None,
) -> list[ToolTouch]:
    """Press several tools at once, without friction; one touch for each, in their order.

    The points of all tools are one complementarity problem. What one tool does to another goes
    through the elements alone, in both directions by the same blocks; so the force on each is the
    slope of one energy in all poses.

    Parameters
    ----------
    young_modulus : pascal; the body's own unless given.
    start : the touches before, in the same order; all tools go on from there together. Without,
        each comes from outside by itself before they are pressed together.

    Raises
    ------
    PalpateError
        As :func:`.tool_contact.press_tool`.
    """
    if start is None:
        touches = [
            press_tool(body, tool, pose, young_modulus=young_modulus) for tool, pose in tools
        ]
    else:
        touches = [
            replace(continued(touch, body, tool, young_modulus), friction=0.0)
            for touch, (tool, _) in zip(start, tools, strict=True)
        ]
    for _ in range(MOST_STRIDES):
        steps = [
            stride(tool, touch.pose, goal)
            for touch, (tool, goal) in zip(touches, tools, strict=True)
        ]
        touches = _settled(touches, [pose for pose, _ in steps])
        if all(arrived for _, arrived in steps):
            return touches
    raise too_far(tools[0][0])


def _settled(states: Sequence[ToolTouch], poses: Sequence[Pose]) -> list[ToolTouch]:
    """All touches with their tools at ``poses``, reached in one step from ``states``."""
    touches = [
        replace(state, pose=pose, free=state.free or is_outside(state, pose))
        for state, pose in zip(states, poses, strict=True)
    ]
    moved = _moved_by_others(touches)
    chosen = [
        looked_at(touch, touch.pose, by_others) if touch.free else touch.points
        for touch, by_others in zip(touches, moved, strict=True)
    ]
    if not any(points.size for points in chosen):
        return touches
    forces = _forces_on(chosen, touches)
    for _ in range(MOST_ADDITIONS):
        parts = _parts(chosen)
        candidates = _candidates(touches, chosen)
        tools = [(touch.tool, touch.pose, part) for touch, part in zip(touches, parts, strict=True)]
        settled = settle_together(candidates, tools, forces)
        after = [
            touch_of(touch, points, _of(settled, part), _own(candidates, part), gone)
            for touch, points, part, gone in zip(
                touches, chosen, parts, _places(candidates, settled, parts), strict=True
            )
        ]
        moved = _moved_by_others(after)
        new = [
            points_entered(touch, touch.pose, points, _of(settled, part), by_others)
            if touch.free
            else points[:0]
            for touch, points, part, by_others in zip(after, chosen, parts, moved, strict=True)
        ]
        if not (settled.exact and any(points.size for points in new)):
            break
        chosen = [np.union1d(points, more) for points, more in zip(chosen, new, strict=True)]
        forces = _forces_on(chosen, after)
    return [
        replace(touch, free=state.free and not has_lost(state, touch, by_others))
        for state, touch, by_others in zip(touches, after, moved, strict=True)
    ]


def _parts(chosen: Sequence[NDArray[np.int64]]) -> list[slice]:
    """Where the points of each tool stand among those of all."""
    ends = np.cumsum([0] + [len(points) for points in chosen]).tolist()
    return [slice(first, end) for first, end in pairwise(ends)]


def _forces_on(
    chosen: Sequence[NDArray[np.int64]], touches: Sequence[ToolTouch]
) -> NDArray[np.float64]:
    """Forces (p, 3) that the touches have on the chosen points of all tools."""
    forces = np.zeros((sum(len(points) for points in chosen), 3))
    for part, points, touch in zip(_parts(chosen), chosen, touches, strict=True):
        forces[part][np.searchsorted(points, touch.points)] = touch.forces
    return forces


def _candidates(touches: Sequence[ToolTouch], chosen: Sequence[NDArray[np.int64]]) -> Candidates:
    """The chosen points of all tools, with the near field among those of each."""
    taken = [touch.surface.taken(points) for touch, points in zip(touches, chosen, strict=True)]
    together = ContactPoints(
        *(
            np.concatenate([getattr(points, name) for points in taken])
            for name in ("positions", "normals", "triangles", "alphas", "areas")
        )
    )
    every = np.arange(len(together))
    elements = _as_matrix(point_compliance(touches[0].body, together, every, every))
    near = np.zeros_like(elements)
    for touch, points, part in zip(touches, chosen, _parts(chosen), strict=True):
        if touch.correction is not None and points.size:
            entries = _entries(part)
            near[entries, entries] = _as_matrix(touch.correction.between(points, points))
    matrix = elements + near
    if not _is_positive(matrix, together, _facing(touches, chosen)):
        matrix = elements + _without_firmness(near)
    none = np.zeros_like(together.positions)
    return Candidates(together.positions, together.normals, matrix / touches[0].young_modulus, none)


def _facing(touches: Sequence[ToolTouch], chosen: Sequence[NDArray[np.int64]]) -> NDArray[np.bool_]:
    """Which of the chosen points face the middle of their tool, (p,)."""
    sides = []
    for touch, points in zip(touches, chosen, strict=True):
        middle = touch.pose.position + touch.pose.rotation @ touch.tool.core.mean(axis=0)
        away = middle - touch.surface.positions[points]
        sides.append(np.einsum("px,px->p", touch.surface.normals[points], away) > 0.0)
    return np.concatenate(sides)


def _is_positive(
    matrix: NDArray[np.float64], points: ContactPoints, pressable: NDArray[np.bool_]
) -> bool:
    """Whether all pushes on the pressable points together take work.

    Points beside and behind the tools, which two tools may share, do not count.
    """
    if not pressable.any():
        return True
    entries = np.repeat(pressable, 3)
    own = along_normals(matrix[np.ix_(entries, entries)], points.normals[pressable])
    least, largest = np.linalg.eigvalsh(own)[[0, -1]]
    return bool(least > -ROUNDING * largest)


def _as_matrix(blocks: NDArray[np.float64]) -> NDArray[np.float64]:
    """Blocks (n, n, 3, 3) as one matrix (3n, 3n)."""
    return blocks.transpose(0, 2, 1, 3).reshape(3 * len(blocks), -1)


def _without_firmness(near: NDArray[np.float64]) -> NDArray[np.float64]:
    """The near field (3n, 3n) without what makes the elements firmer than they are.

    By the rims of thin parts on coarse meshes the near field can be firmer than two tools may meet:
    they would squeeze less than nothing. Elements with what is left are sound.
    """
    values, vectors = np.linalg.eigh(near)
    kept: NDArray[np.float64] = (vectors * np.maximum(values, 0.0)) @ vectors.T
    return kept


def _entries(part: slice) -> slice:
    """Where the three coordinates of one tool's points stand among those of all."""
    return slice(3 * part.start, 3 * part.stop)


def _own(candidates: Candidates, part: slice) -> NDArray[np.float64]:
    """The compliance of one tool's points among themselves, (3p, 3p)."""
    entries = _entries(part)
    return candidates.compliance[entries, entries]


def _of(settled: Settled, part: slice) -> Settled:
    return replace(
        settled,
        forces=settled.forces[part],
        pushes=settled.pushes[part],
        normals=settled.normals[part],
        displacements=settled.displacements[part],
    )


def _places(
    candidates: Candidates, settled: Settled, parts: Sequence[slice]
) -> list[NDArray[np.float64]]:
    """Where each tool's points are now."""
    places = candidates.positions + settled.displacements
    return [places[part] for part in parts]


def _moved_by_others(touches: Sequence[ToolTouch]) -> list[NDArray[np.float64]]:
    """How far the other tools move all contact points of each, (P, 3)."""
    return [
        moved_by(touch, np.arange(len(touch.surface)), _together([*touches[:i], *touches[i + 1 :]]))
        for i, touch in enumerate(touches)
    ]


def energy_of(touches: Sequence[ToolTouch]) -> float:
    """Elastic energy, joule, that all touches together hold in the body."""
    energy = sum(touch.energy for touch in touches)
    for i, touch in enumerate(touches):
        for other in touches[i + 1 :]:
            energy += _work_through_body(touch, other)
    return energy


def _work_through_body(touch: ToolTouch, other: ToolTouch) -> float:
    """Forces of one touch times what the other moves their nodes by, joule."""
    body, modulus = touch.body, touch.young_modulus
    here, there = (body.free_index(each.nodes) for each in (touch, other))
    held_here, held_there = here >= 0, there >= 0
    moved = body.compliance.apply(other.nodal_forces[held_there] / modulus, there[held_there])
    return float((touch.nodal_forces[held_here] * moved[here[held_here]]).sum())


def _together(touches: Sequence[ToolTouch]) -> Load:
    """All forces of the touches as one load."""
    return Load(
        np.concatenate([np.empty(0, dtype=np.int64)] + [touch.nodes for touch in touches]),
        np.concatenate([np.empty((0, 3))] + [touch.nodal_forces for touch in touches]),
    )
