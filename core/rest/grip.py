"""A place of a free body that a finger without size takes hold of, or presses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from palpate_servo import MAX_FINGERS, closest_points

from ..body.soft_body import SoftBody
from ..contact.tool.pose import Pose
from ..errors import PalpateError
from .support import friction_checked

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import LaidPoint


# As many hold and press a body at most.
MOST_GRIPS: int = MAX_FINGERS


@dataclass(frozen=True, eq=False)
class Grip:
    """Place at rest on the surface, led to a place in the world.

    Attributes
    ----------
    at : float64 (3,), metres, in the body's own frame; the nearest place of the surface counts.
    friction : None for a finger that holds the place, and pulls or carries the body by it; else
        Coulomb's coefficient of one that only presses it inwards.

    Raises
    ------
    PalpateError
        A friction that is negative or no number, a place that is none.
    """

    at: NDArray[np.float64] | tuple[float, float, float]
    friction: float | None = None

    def __post_init__(self) -> None:
        if self.friction is not None:
            friction_checked(self.friction)
        at = np.array(self.at, dtype=np.float64)
        if at.shape != (3,) or not np.isfinite(at).all():
            raise PalpateError("grip: at is {at}; give a place, three numbers", at=at.tolist())
        object.__setattr__(self, "at", at)


def native_grip(body: SoftBody, grip: Grip, goal: Pose) -> LaidPoint:
    """The grip as the native module has it: triangle of the surface, area coordinates in it."""
    mesh = body.mesh
    nodes = mesh.nodes[mesh.surface_nodes]
    triangle, alpha = closest_points(nodes, mesh.surface_local_triangles, np.asarray(grip.at)[None])
    x, y, z = (float(part) for part in goal.position)
    a, b, c = (float(part) for part in alpha[0])
    return int(triangle[0]), (a, b, c), grip.friction, (x, y, z)
