"""A plush teddy, 110 mm tall, sitting with its legs forward, its face towards +x. No Blender."""

import numpy as np
from distance import Distances, Points, ellipsoid, round_cone, smooth_union
from mouse_shape import Part, QuadMesh, ball
from surface_net import project, surface_net

QUAD_SIZE = 3.0  # millimetres


def teddy() -> QuadMesh:
    """Build the whole teddy, always the same."""
    low, high = np.array([-36.0, -48.0, -10.0]), np.array([60.0, 48.0, 118.0])
    body, quads = surface_net(plush, low, high, QUAD_SIZE)
    parts = [(body, quads, Part.PLUSH)]
    for side in (1.0, -1.0):
        eye = project(plush, np.array([[22.0, side * 9.5, 84.0]]), 0.05, rounds=4)[0]
        parts.append((*ball(eye - [0.8, side * 0.2, 0.1], np.array([2.6, 2.6, 2.8]), 6), Part.BEAD))
    nose = project(plush, np.array([[34.0, 0.0, 78.0]]), 0.05, rounds=4)[0]
    parts.append((*ball(nose - [0.6, 0, 0], np.array([2.6, 3.8, 2.8]), 6), Part.FELT))
    return QuadMesh.of_parts(parts, felt_seam(body), np.full(len(body), 10.0))


def plush(points: Points) -> Distances:
    """Signed distance of trunk, head, ears, arms and legs (mm)."""
    mirrored = np.column_stack([points[:, 0], np.abs(points[:, 1]), points[:, 2]])
    trunk = ellipsoid(points, (0, 0, 30), (23, 25, 32))
    head = ellipsoid(points, (4, 0, 80), (22, 24, 21))
    muzzle = ellipsoid(points, (24, 0, 74), (11, 12, 9))
    shape = smooth_union(smooth_union(trunk, head, 8.0), muzzle, 5.0)
    ear = ellipsoid(mirrored, (1, 20, 99), (5, 9, 9))
    shape = smooth_union(shape, ear, 4.0)
    arm = round_cone(mirrored, (2, 22, 50), (20, 34, 30), 9.0, 8.0)
    shape = smooth_union(shape, arm, 5.0)
    leg = round_cone(mirrored, (4, 15, 8), (40, 21, 6), 12.0, 11.0)
    return smooth_union(shape, leg, 5.0)


def felt_seam(points: Points) -> Distances:
    """Signed distance to the seam between plush and felt (mm), negative on the felt side."""
    muzzle = ellipsoid(points, (30, 0, 74), (9, 11, 8.5))
    mirrored = np.column_stack([points[:, 0], np.abs(points[:, 1]), points[:, 2]])
    sole = np.maximum(
        np.linalg.norm(mirrored[:, 1:] - [21.0, 6.0], axis=1) - 8.0, 46.0 - points[:, 0]
    )
    ear = np.maximum(
        np.linalg.norm(mirrored[:, 1:] - [20.5, 99.5], axis=1) - 6.0, 3.0 - points[:, 0]
    )
    return np.minimum(np.minimum(muzzle, sole), np.minimum(ear, 10.0))
