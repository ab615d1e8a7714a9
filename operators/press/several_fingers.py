"""Fingers on one body without a clock: numpy alone, for scripts, animation and background Blender.

Points are solved together; tools one after the other, each in the shape that the others leave,
until nothing changes any more (block Gauss-Seidel).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.equations import Touch
from ...core.contact.tool.tool_contact import press_tool
from ...core.contact.tool.tool_dent import PressingTool
from ...core.contact.tool.tool_touch import Load, ToolTouch
from ...core.contact.tool.tools import Pose, Tool
from ...core.shape.meeting import FingerLoad

Array = NDArray[np.float64]

# Fingers are settled when no force changes by more than this share, or after so many rounds.
SETTLED, MOST_ROUNDS = 1e-6, 60


@dataclass(frozen=True, eq=False)
class FingerForce:
    """What one finger does; body axes, SI units.

    Attributes
    ----------
    force : (3,), felt by the finger.
    nodes, nodal_forces : (k,) and (k, 3), on the body, by the linear relation.
    area, largest_pressure : m^2 and Pa; 0 for a point.
    touch : the contact of a point finger, None for a tool.
    tool : the contact of a tool, None for a point.
    """

    force: Array
    nodes: NDArray[np.int64]
    nodal_forces: Array
    area: float = 0.0
    largest_pressure: float = 0.0
    touch: Touch | None = None
    tool: ToolTouch | None = None


def pressing_tools(fingers: Sequence[FingerForce]) -> tuple[PressingTool, ...]:
    """The tools among the fingers, for drawing."""
    return tuple(
        PressingTool(finger.tool.tool, finger.tool.pose, finger.force)
        for finger in fingers
        if finger.tool is not None
    )


def of_point(touch: Touch, felt: Array) -> FingerForce:
    """A point finger's, with the force (3,) that it feels."""
    return FingerForce(felt, touch.triangle, touch.nodal_forces, touch=touch)


def of_tool(touch: ToolTouch) -> FingerForce:
    """A tool's."""
    pressures = np.asarray(touch.pressures)
    return FingerForce(
        touch.force,
        touch.nodes,
        touch.nodal_forces,
        area=contact_area(touch.forces, pressures),
        largest_pressure=float(pressures.max(initial=0.0)),
        tool=touch,
    )


def contact_area(forces: Array, pressures: Array) -> float:
    """The surface that carries forces (p, 3) at pressures (p,), m^2."""
    carries = pressures > 0.0
    return float(np.sum(np.linalg.norm(forces[carries], axis=1) / pressures[carries]))


@dataclass(frozen=True, eq=False)
class ToolPress:
    """Tools that press one body together.

    ``touches`` holds each tool's contact, None before the first.
    """

    body: SoftBody
    tool: Tool
    young_modulus: float
    friction: float
    touches: tuple[ToolTouch | None, ...]

    def to(self, poses: Sequence[Pose]) -> ToolPress:
        """The tools at these poses, one each, reached in steps from where they were."""
        before = [
            pose if touch is None else touch.pose
            for touch, pose in zip(self.touches, poses, strict=True)
        ]
        count = max(
            steps_between(self.tool, start, end) for start, end in zip(before, poses, strict=True)
        )
        press = self
        for step in range(1, count + 1):
            here = [
                between(start, end, step / count) for start, end in zip(before, poses, strict=True)
            ]
            press = press._settled(here)
        return press

    def _settled(self, poses: Sequence[Pose]) -> ToolPress:
        touches = list(self.touches)
        starts = tuple(touches)
        for _ in range(MOST_ROUNDS if len(poses) > 1 else 1):
            change = 0.0
            for number, pose in enumerate(poses):
                others = [t for k, t in enumerate(touches) if k != number and t is not None]
                new = press_tool(
                    self.body,
                    self.tool,
                    pose,
                    young_modulus=self.young_modulus,
                    friction=self.friction,
                    start=starts[number],
                    outside=_load(others),
                )
                change = max(change, _change(touches[number], new))
                touches[number] = new
            if change <= SETTLED:
                break
        return replace(self, touches=tuple(touches))

    @property
    def fingers(self) -> tuple[FingerForce, ...]:
        """What each tool does."""
        return tuple(of_tool(touch) for touch in self.touches if touch is not None)


def steps_between(tool: Tool, start: Pose, end: Pose) -> int:
    """In how many steps a tool gets from one pose to another; never 0."""
    way = float(np.linalg.norm(end.position - start.position))
    turn = float(np.linalg.norm(end.rotation - start.rotation)) * tool.size
    return max(1, int(np.ceil((way + turn) / tool.stride)))


def between(start: Pose, end: Pose, share: float) -> Pose:
    """A pose on the way, the rotation by the nearest one to the mean of the matrices."""
    mixed = (1.0 - share) * start.rotation + share * end.rotation
    left, _, right = np.linalg.svd(mixed)
    sign = np.diag([1.0, 1.0, np.linalg.det(left @ right)])
    position = (1.0 - share) * start.position + share * end.position
    return end if share >= 1.0 else Pose(position, left @ sign @ right)


def loads_of(fingers: Sequence[FingerForce]) -> list[FingerLoad]:
    """What the body bears, of all fingers that press."""
    return [
        FingerLoad(finger.nodes, finger.nodal_forces) for finger in fingers if len(finger.nodes)
    ]


def _load(touches: Sequence[ToolTouch]) -> Load | None:
    if not touches:
        return None
    return Load(
        np.concatenate([touch.nodes for touch in touches]),
        np.concatenate([touch.nodal_forces for touch in touches]),
    )


def _change(old: ToolTouch | None, new: ToolTouch) -> float:
    """By how much the force changed, as a share of it."""
    if old is None:
        return np.inf
    size = float(np.linalg.norm(new.force))
    return float(np.linalg.norm(new.force - old.force)) / size if size > 0.0 else 0.0
