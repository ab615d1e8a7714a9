"""A free body followed through a time in which what touches it moves, tick by tick."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool
from .resting import Resting

# Seconds of a tick at most, each with as much work as one of the servo's: what is left of that is
# done in the next.
TICK = 4e-3
# Share of its inner radius by which a tool goes in a tick at most; half of a stride.
WAY_PER_RADIUS = 0.125


@dataclass(frozen=True, eq=False)
class Ways:
    """Tools and supports of a body with the poses from which and to which they go, as many of each.

    A support that does not move, as a floor, has the same pose twice.
    """

    tools: Sequence[tuple[Tool, Pose, Pose]]
    supports: Sequence[tuple[Tool | None, Pose, Pose]]


def follow(resting: Resting, ways: Ways, seconds: float) -> None:
    """Let a time pass in which all go straight along their ways, without a pause.

    Raises
    ------
    PalpateError
        A force is no number.
    """
    ticks = _ticks(ways, seconds)
    for tick in range(1, ticks + 1):
        share = tick / ticks
        resting.lead([between(start, end, share) for _, start, end in ways.tools])
        for number, (_, start, end) in enumerate(ways.supports):
            if start is not end:
                resting.move_support(number, between(start, end, share))
        resting.tick(seconds / ticks, hurried=True)


def between(start: Pose, end: Pose, share: float) -> Pose:
    """Pose at a share of the straight way between two."""
    turn = Rotation.from_matrix(end.rotation @ start.rotation.T).as_rotvec()
    rotation = Rotation.from_rotvec(share * turn).as_matrix() @ start.rotation
    return Pose(start.position + share * (end.position - start.position), rotation)


def _ticks(ways: Ways, seconds: float) -> int:
    needed = [seconds / TICK]
    for tool, start, end in (*ways.tools, *ways.supports):
        if tool is not None:
            needed.append(_way(tool, start, end) / (WAY_PER_RADIUS * tool.inner_radius))
    return max(1, math.ceil(max(needed) - 1e-9))


def _way(tool: Tool, start: Pose, end: Pose) -> float:
    """How far the tool's farthest place goes, about, metres."""
    turn = Rotation.from_matrix(end.rotation @ start.rotation.T).magnitude()
    step: NDArray[np.float64] = end.position - start.position
    return float(np.linalg.norm(step)) + float(turn) * tool.reach
