"""Poses of tools: facing a surface, a view or an object, and set down from outside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import PalpateError
from ...mesh.coordinates import refuse_unusable
from ...sentence import Sentence
from .tools import Tool

Array = NDArray[np.float64]

# Steps to lift a tool off a curved surface: a few, more where it grazes.
MOST_LIFTS = 64
# Height of a tool above the surface when set down, as a share of its size or the body's, whichever
# is less.
AIR = 1e-4


@dataclass(frozen=True, eq=False)
class Pose:
    """Pose of a tool: ``position`` (3,) of its reference point in metres, body coordinates, and
    ``rotation`` (3, 3), tool to body.
    """

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]

    @classmethod
    def at(cls, position: ArrayLike, rotation: ArrayLike | None = None) -> Pose:
        """Pose from numbers, checked; without ``rotation`` the tool's axes are the body's.

        Raises
        ------
        PalpateError
            A position that is not three finite numbers, an invalid rotation.
        """
        place = np.array(position, dtype=np.float64)
        turn = np.eye(3) if rotation is None else np.array(rotation, dtype=np.float64)
        if place.shape != (3,):
            raise PalpateError(
                "tool's pose: position has shape {shape}, expected (3,); give x, y, z",
                shape=place.shape,
            )
        refuse_unusable(Sentence("tool's pose"), place[None])
        if (
            turn.shape != (3, 3)
            or not np.allclose(turn @ turn.T, np.eye(3), atol=1e-6)
            or np.linalg.det(turn) < 0
        ):
            raise PalpateError(
                "tool's pose: rotation is not a rotation; give a (3, 3) matrix of orthogonal unit "
                "columns, right-handed, without scale"
            )
        return cls(place, turn)

    def moved(self, by: NDArray[np.float64]) -> Pose:
        """The pose moved by a way (3,), metres, and turned as it is."""
        return Pose(self.position + by, self.rotation)

    def to_world(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (..., 3) of the frame that is so posed, in the frame in which it is."""
        placed: NDArray[np.float64] = points @ self.rotation.T + self.position
        return placed

    def to_tool(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Body coordinates (p, 3) in the tool's frame."""
        own: NDArray[np.float64] = (points - self.position) @ self.rotation
        return own

    def pose_to_tool(self, pose: Pose) -> Pose:
        """A pose in this one's frame."""
        turned: NDArray[np.float64] = self.rotation.T @ pose.rotation
        return Pose(self.to_tool(pose.position), turned)


def facing(direction: Array, along: Array) -> Array:
    """Rotation (3, 3), tool to body, of a tool that lies in the direction ``direction`` (3,) of
    what it presses: its z axis. Its x axis follows ``along`` (3,) as far as it can.
    """
    z = direction / np.linalg.norm(direction)
    x = along - (along @ z) * z
    if np.linalg.norm(x) < 1e-6 * max(1.0, float(np.linalg.norm(along))):
        # Any axis will do that is not along z.
        x = np.eye(3)[np.argmin(np.abs(z))]
        x = x - (x @ z) * z
    x = x / np.linalg.norm(x)
    rotation: Array = np.column_stack([x, np.cross(z, x), z])
    return rotation


def reach(tool: Tool, rotation: Array, direction: Array) -> float:
    """Extent of the tool from its reference point along ``direction`` (3,), unit, m."""
    return float((tool.core @ rotation.T @ direction).max()) + tool.radius


def resting_on(tool: Tool, rotation: Array, point: Array, normal: Array, surface: Array) -> Pose:
    """Pose of a tool just out of contact with a surface, above ``point`` (3,) on it.

    ``normal`` (3,) is the outward unit normal there. Places ``surface`` (n, 3) of a
    rising surface keep the tool further off. They should be those that the tool will touch, or it
    may be set down inside one of them, without force.
    """
    air = AIR * min(tool.size, float(np.ptp(surface, axis=0).max(initial=0.0)))
    position = point + (reach(tool, rotation, -normal) + air) * normal
    near = surface[np.linalg.norm(surface - position, axis=1) < 2.0 * tool.reach]
    for _ in range(MOST_LIFTS if len(near) else 0):
        distance, _normals = tool.distance((near - position) @ rotation)
        inside = -float(distance.min())
        if inside < 0.0:
            break
        position = position + (inside + air) * normal
    return Pose(position, rotation)
