"""Free bodies followed through a time in which what touches them moves, tick by tick."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool

# Seconds of a tick at most, each with as much work as one of the servo's: what is left of that is
# done in the next.
TICK = 4e-3
# Share of its inner radius by which a tool goes in a tick at most; half of a stride.
WAY_PER_RADIUS = 0.125


class Followed(Protocol):
    """A free body, or several that press each other."""

    def lead(self, goals: Sequence[Pose]) -> None:
        """Have the tools go to their goals from the next tick on."""

    def move_support(self, number: int, pose: Pose) -> None:
        """Have a support be elsewhere from the next tick on."""

    def hurry(self, seconds: float) -> None:
        """Go on by a tick, with as much work as there is time for while somebody waits."""


@dataclass(frozen=True, eq=False)
class Ways:
    """Tools and supports of bodies with the poses from which and to which they go, as many of each.

    A support that does not move, as a floor, has the same pose twice.
    """

    tools: Sequence[tuple[Tool, Pose, Pose]]
    supports: Sequence[tuple[Tool | None, Pose, Pose]]


def follow(bodies: Followed, ways: Ways, seconds: float) -> None:
    """Let a time pass in which all go straight along their ways, without a pause.

    Raises
    ------
    PalpateError
        A force is no number.
    """
    ticks = _ticks(ways, seconds)
    for tick in range(1, ticks + 1):
        share = tick / ticks
        bodies.lead([between(start, end, share) for _, start, end in ways.tools])
        for number, (_, start, end) in enumerate(ways.supports):
            if start is not end:
                bodies.move_support(number, between(start, end, share))
        bodies.hurry(seconds / ticks)


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
