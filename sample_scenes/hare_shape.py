"""A plush hare with long ears, 190 mm tall, sitting upright on z = 0, head towards +x. No Blender.

Its ears are slender: a touch at a tip turns them far, which is where a linear shape swells.
"""

import numpy as np
from distance import (
    Distances,
    Points,
    ellipsoid,
    round_cone,
    smooth_intersection,
    smooth_union,
)
from mouse_shape import Part, QuadMesh, ball
from numpy.typing import NDArray
from surface_net import project, surface_net

QUAD_SIZE = 2.5  # millimetres
# An ear is an ellipsoid, turned outwards and bent backwards from the height of the skull on.
EAR_CENTRE, EAR_RADII = np.array([8.0, 15.0, 137.0]), np.array([5.8, 10.5, 55.0])
EAR_LEAN, EAR_BEND, EAR_BASE = 0.13, 0.0013, 84.0
INNER_EAR = 0.68  # of the ear's width and length


def hare() -> QuadMesh:
    """Build the whole hare, always the same."""
    low, high = np.array([-62.0, -52.0, -4.0]), np.array([62.0, 52.0, 200.0])
    body, body_quads = surface_net(plush, low, high, QUAD_SIZE)
    parts = [(body, body_quads, Part.PLUSH)]
    for side in (1.0, -1.0):
        eye = np.array([[30.0, side * 13.5, 76.0]])
        seat = project(plush, eye, 0.05, rounds=4)[0] - np.array([0.5, side * 0.7, 0.2])
        parts.append((*ball(seat, np.array([3.8, 3.8, 4.2]), 6), Part.BEAD))
    nose = project(plush, np.array([[46.0, 0.0, 69.0]]), 0.05, rounds=4)[0]
    parts.append((*ball(nose - [1.0, 0, 0], np.array([3.4, 4.2, 3.2]), 6), Part.FELT))
    return QuadMesh.of_parts(parts, felt_seam(body), quilt_seam(body))


def ear_tip(side: float) -> Points:
    """The highest place (3,) of an ear, metres; ``side`` is 1 for the left, -1 for the right."""
    lean = np.array([0.0, np.sin(EAR_LEAN), np.cos(EAR_LEAN)])
    tip = EAR_CENTRE + 0.97 * EAR_RADII[2] * lean
    tip[0] -= EAR_BEND * (tip[2] - EAR_BASE) ** 2
    place: Points = 1e-3 * project(plush, tip[None] * [1.0, side, 1.0], 0.05, rounds=6)[0]
    return place


def plush(points: Points) -> Distances:
    """Signed distance of body, head, ears, feet and tail, flat underneath (mm)."""
    mirrored = _folded(points)
    trunk = ellipsoid(points, (-14, 0, 28), (31, 27, 30))
    chest = ellipsoid(points, (3, 0, 42), (20, 19, 27))
    belly = ellipsoid(points, (6, 0, 17), (24, 23, 20))
    head = ellipsoid(points, (15, 0, 75), (21, 18, 18))
    muzzle = round_cone(points, (24, 0, 70), (37, 0, 66.5), 12.0, 8.0)
    shape = smooth_union(smooth_union(trunk, chest, 14.0), belly, 10.0)
    shape = smooth_union(shape, head, 9.0)
    shape = smooth_union(shape, muzzle, 8.0)
    cheek = ellipsoid(mirrored, (28, 8, 66), (9, 8.5, 8.5))
    shape = smooth_union(shape, cheek, 6.0)
    haunch = ellipsoid(mirrored, (-9, 21, 22), (24, 13, 23))
    shape = smooth_union(shape, haunch, 8.0)
    arm = round_cone(mirrored, (16, 13, 44), (27, 10, 7), 8.0, 6.5)
    shape = smooth_union(shape, arm, 6.0)
    shape = smooth_union(shape, ellipsoid(points, (-46, 0, 17), (11, 10, 10)), 4.0)
    shape = smooth_union(shape, _ear(mirrored), 9.0)
    shape = smooth_union(shape, _feet(mirrored), 4.0)
    return smooth_intersection(shape, -points[:, 2], 3.0)


def felt_seam(points: Points) -> Distances:
    """Signed distance to the seam between plush and felt (mm), negative on the felt side."""
    along = _in_ear(_folded(points))
    across = along / np.array([1.0, INNER_EAR * EAR_RADII[1], INNER_EAR * EAR_RADII[2]])
    dish = INNER_EAR * EAR_RADII[1] * (np.hypot(across[:, 1], across[:, 2]) - 1.0)
    inner_ear = np.maximum(dish, 1.0 - along[:, 0])
    trunk = ellipsoid(_folded(points), (-14, 0, 28), (31, 27, 30))
    feet = _feet(_folded(points)) - np.minimum(trunk, 6.0) + 0.6
    return np.where(points[:, 2] < 14.0, np.minimum(feet, 10.0), np.minimum(inner_ear, 10.0))


def quilt_seam(points: Points) -> Distances:
    """Signed distance to the border of the stitched trunk (mm): head, ears and tail stay plain."""
    return np.minimum(54.0 - points[:, 2], points[:, 0] + 36.0)


def _folded(points: Points) -> Points:
    """Both halves laid onto y >= 0."""
    return np.column_stack([points[:, 0], np.abs(points[:, 1]), points[:, 2]])


def _in_ear(mirrored: Points) -> Points:
    """Coordinates in the ear: towards its front, across, and along it (mm)."""
    straight = mirrored - EAR_CENTRE
    straight[:, 0] += EAR_BEND * np.maximum(mirrored[:, 2] - EAR_BASE, 0.0) ** 2
    cosine, sine = np.cos(EAR_LEAN), np.sin(EAR_LEAN)
    across = cosine * straight[:, 1] - sine * straight[:, 2]
    along = sine * straight[:, 1] + cosine * straight[:, 2]
    return np.column_stack([straight[:, 0], across, along])


def _ear(mirrored: Points) -> Distances:
    return ellipsoid(_in_ear(mirrored), (0.0, 0.0, 0.0), EAR_RADII)


def _feet(mirrored: Points) -> Distances:
    paw = ellipsoid(mirrored, (31, 10, 5.0), (10, 7.0, 6.0))
    foot = ellipsoid(mirrored, (13, 25, 5), (26, 8.5, 7))
    return np.minimum(paw, foot)


def vertices_of(shape: QuadMesh, part: Part) -> NDArray[np.int64]:
    """Numbers of the vertices of one part."""
    return np.unique(shape.quads[shape.part == part])
