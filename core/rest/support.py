"""What a free body rests on: a floor without an edge, fixed tools."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool, plate
from ..errors import PalpateError

# Sizes of a body that a part of a floor is wide which stands for it.
WIDE = 30.0


@dataclass(frozen=True, eq=False)
class Floor:
    """Half-space that bears bodies.

    Attributes
    ----------
    height : metres, of its surface over the origin, along ``up``.
    friction : Coulomb's coefficient.
    up : float64 (3,), its outward normal; of unit length, made so.

    Raises
    ------
    PalpateError
        A friction that is negative or no number, an ``up`` that is no direction.
    """

    height: float = 0.0
    friction: float = 0.5
    up: NDArray[np.float64] | tuple[float, float, float] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        friction_checked(self.friction)
        up = np.array(self.up, dtype=np.float64)
        length = float(np.linalg.norm(up))
        if up.shape != (3,) or not (0.0 < length < np.inf):
            raise PalpateError("floor: up is {up}; give a direction, three numbers", up=up.tolist())
        object.__setattr__(self, "up", up / length)

    @property
    def pose(self) -> Pose:
        """Its surface's frame: z outwards."""
        up = np.asarray(self.up)
        aside = np.eye(3)[int(np.abs(up).argmin())]
        x = np.cross(aside, up)
        x /= np.linalg.norm(x)
        return Pose(self.height * up, np.column_stack([x, np.cross(up, x), up]))


@dataclass(frozen=True, eq=False)
class Support:
    """Fixed tool that bears bodies: a plate, rod, ball or convex mesh, at ``pose`` in the world.

    ``friction`` is Coulomb's coefficient; errors as of :class:`Floor`.
    """

    tool: Tool
    pose: Pose
    friction: float = 0.5

    def __post_init__(self) -> None:
        friction_checked(self.friction)


def as_tool(support: Floor | Support, near: NDArray[np.float64], size: float) -> tuple[Tool, Pose]:
    """A support as a tool with its pose in the world; of a floor the part that a body ``near`` (3,)
    of a ``size``, metres, may meet.
    """
    if isinstance(support, Support):
        return support.tool, support.pose
    pose, up = support.pose, np.asarray(support.up)
    beneath = near - (near @ up - support.height) * up
    return _wide_plate(WIDE * size), Pose(beneath, pose.rotation * [1.0, -1.0, -1.0])


@lru_cache(maxsize=16)
def _wide_plate(width: float) -> Tool:
    return plate(width, width, rounding=1e-3 * width, name="floor")


def friction_checked(friction: float) -> float:
    """A coefficient of friction.

    Raises
    ------
    PalpateError
        It is negative or no number.
    """
    if not 0.0 <= friction < np.inf:
        raise PalpateError(
            "the coefficient of friction is {friction}; give a number, zero or more",
            friction=friction,
        )
    return friction
