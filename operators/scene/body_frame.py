"""Map between Blender's coordinates and metres: the only one between an object and its soft body.

An object's matrix M = R P (polar decomposition) has a rigid part R and a symmetric stretch P that
carries scale, shear and mirroring. The body is in ``metres_per_unit * P @ local``: of true
size, and invariant when the object is moved or rotated.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.contact.tool.pose import Pose
from ...core.errors import PalpateError

Array = NDArray[np.float64]
Point = tuple[float, float, float]

# Relative difference of equal stretches: matrices are float32.
SAME_STRETCH = 1e-5

# Stretches below this share of the largest one count as flat.
SMALLEST_RELATIVE_STRETCH = 1e-6


@dataclass(frozen=True, eq=False)
class BodyFrame:
    """Map between an object's local coordinates, its body in metres, and the world.

    Attributes
    ----------
    rotation : R, (3, 3), det = +1: body axes in the world.
    stretch : P, (3, 3), symmetric; negative definite or indefinite where the object is mirrored.
    origin : (3,), the object's origin in world units.
    metres_per_unit : the scene's unit scale.
    """

    rotation: Array
    stretch: Array
    origin: Array
    metres_per_unit: float

    @classmethod
    def of_matrix(cls, matrix_world: ArrayLike, metres_per_unit: float = 1.0) -> BodyFrame:
        """Decompose a 4x4 object matrix.

        Raises
        ------
        PalpateError
            A matrix that is not finite, or that flattens the object (a scale of zero).
        """
        matrix = np.asarray(matrix_world, dtype=np.float64)
        if not np.isfinite(matrix).all():
            raise PalpateError(
                "the object's transform has numbers that are not finite; clear its location, "
                "rotation and scale (Object > Clear)"
            )
        left, stretches, right = np.linalg.svd(matrix[:3, :3])
        if stretches[2] <= SMALLEST_RELATIVE_STRETCH * stretches[0]:
            raise PalpateError(
                "the object's scale is zero along an axis, so it has no volume; give it a scale "
                "other than zero (Object > Clear > Scale)"
            )
        rotation, stretch = left @ right, (right.T * stretches) @ right
        if np.linalg.det(rotation) < 0.0:
            rotation, stretch = -rotation, -stretch
        return cls(rotation, stretch, matrix[:3, 3].copy(), float(metres_per_unit))

    @property
    def matrix(self) -> Array:
        """The object's matrix (4, 4)."""
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = self.rotation @ self.stretch, self.origin
        return matrix

    @property
    def mirrored(self) -> bool:
        """Whether the stretch mirrors the surface, so that triangles must be rewound."""
        return bool(np.linalg.det(self.stretch) < 0.0)

    @property
    def metric(self) -> Array:
        """Metres of body per local unit, (3, 3): the part of the frame that a body depends on."""
        return self.metres_per_unit * self.stretch

    def stretches_as(self, other: BodyFrame) -> bool:
        """Whether a body is the same in both frames, but for rounding."""
        difference = np.abs(other.metric - self.metric).max()
        return bool(difference <= SAME_STRETCH * np.abs(self.metric).max())

    def body_from_local(self, local: ArrayLike) -> Array:
        """Local coordinates (p, 3) to metres in the body."""
        body: Array = np.asarray(local, dtype=np.float64) @ self.metric
        return body

    def local_from_body(self, body: ArrayLike) -> Array:
        """Points or displacements (p, 3) in the body, metres, to local units."""
        local: Array = np.asarray(body, dtype=np.float64) @ np.linalg.inv(self.metric)
        return local

    def world_from_body(self, body: ArrayLike) -> Array:
        """Points (..., 3) in the body, metres, to world units."""
        points = np.asarray(body, dtype=np.float64) / self.metres_per_unit
        world: Array = points @ self.rotation.T + self.origin
        return world

    def body_from_world(self, world: ArrayLike) -> Array:
        """Points (..., 3) in world units to metres in the body."""
        offset = np.asarray(world, dtype=np.float64) - self.origin
        body: Array = self.metres_per_unit * (offset @ self.rotation)
        return body

    def turn_to_world(self, vectors: ArrayLike) -> Array:
        """Directions or forces (..., 3) from body axes to world axes; lengths stay."""
        turned: Array = np.asarray(vectors, dtype=np.float64) @ self.rotation.T
        return turned

    def turn_to_body(self, vectors: ArrayLike) -> Array:
        """Directions or forces (..., 3) from world axes to body axes; lengths stay."""
        turned: Array = np.asarray(vectors, dtype=np.float64) @ self.rotation
        return turned

    def posed(self, turn: Array, rest: Array, seen: Array) -> BodyFrame:
        """Frame in which the place ``rest`` (3,) of the body is where ``seen`` (3,) is, turned by
        ``turn`` (3, 3); both in metres, body coordinates of this frame.
        """
        rotation = self.rotation @ turn
        origin = self.world_from_body(seen) - rotation @ rest / self.metres_per_unit
        return replace(self, rotation=rotation, origin=origin)

    def pose_in(self, other: BodyFrame) -> Pose:
        """Where this frame's body coordinates are in those of another, metres."""
        return Pose(other.body_from_world(self.origin), other.rotation.T @ self.rotation)

    def wind(self, triangles: NDArray[np.int64]) -> NDArray[np.int64]:
        """Triangles (m, 3) of the local surface, rewound if mirrored."""
        return triangles[:, ::-1] if self.mirrored else triangles


def as_point(vector: Array) -> Point:
    """Vector (3,) as plain numbers."""
    x, y, z = vector.tolist()
    return (x, y, z)
