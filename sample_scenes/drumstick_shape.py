"""A drumstick, 160 mm long, on z = 0: meat, and the bone that runs through it. No Blender here.

Meat and bone are two closed surfaces in one mesh. The bone lies deep in the thick end, close under
the skin where the meat tapers, and bare behind that, so that one press differs from the next.
"""

from enum import IntEnum

import numpy as np
from distance import (
    Distances,
    Points,
    ellipsoid,
    round_cone,
    smooth_intersection,
    smooth_union,
)
from mouse_shape import QuadMesh
from numpy.typing import NDArray
from surface_net import project, surface_net

MEAT_QUAD, BONE_QUAD = 2.6, 2.2  # millimetres
MEAT_END, BONE_END = np.array([-20.0, 0.0, 33.0]), np.array([86.0, 0.0, 11.0])


class Part(IntEnum):
    """Material slots of the drumstick, in order."""

    MEAT = 0
    BONE = 1


def drumstick() -> QuadMesh:
    """Build meat and bone, always the same."""
    low, high = np.array([-68.0, -42.0, -4.0]), np.array([104.0, 42.0, 74.0])
    outer, outer_quads = surface_net(meat, low, high, MEAT_QUAD)
    inner, inner_quads = surface_net(bone, low, high, BONE_QUAD)
    vertices = np.concatenate([outer, inner])
    vertices[:, 2] = np.maximum(vertices[:, 2], 0.0)
    parts = (np.full(len(outer_quads), Part.MEAT), np.full(len(inner_quads), Part.BONE))
    plain = np.full(len(vertices), 0.01)
    return QuadMesh(
        vertices=1e-3 * vertices,
        quads=np.concatenate([outer_quads, inner_quads + len(outer)]),
        part=np.concatenate(parts).astype(np.int64),
        felt=plain,
        quilt=plain,
    )


def bone_vertices(shape: QuadMesh) -> NDArray[np.int64]:
    """Numbers of the vertices of the bone."""
    return np.unique(shape.quads[shape.part == Part.BONE])


def top_of_meat(x: float) -> Points:
    """The highest place of the meat (3,) at ``x``, both in metres."""
    above = np.array([[1e3 * x, 0.0, 1e3 * x * -0.45 + 55.0]])
    place: Points = 1e-3 * project(meat, above, 0.05, rounds=8)[0]
    return place


def meat(points: Points) -> Distances:
    """Signed distance of the meat, flat underneath (mm)."""
    thick = ellipsoid(points, MEAT_END, (40, 35, 34.5))
    taper = round_cone(points, (0, 0, 29), (46, 0, 19.5), 27.0, 12.0)
    cuff = round_cone(points, (46, 0, 19.5), (56, 0, 17.3), 12.0, 12.5)
    shape = smooth_union(smooth_union(thick, taper, 16.0), cuff, 6.0)
    return smooth_intersection(shape, -points[:, 2], 3.0)


def bone(points: Points) -> Distances:
    """Signed distance of the bone with its two knobs, flat underneath (mm)."""
    shaft = round_cone(points, (-26, 0, 34), BONE_END, 8.0, 7.0)
    head = ellipsoid(points, (-30, 0, 35), (13, 12, 12))
    folded = np.column_stack([points[:, 0], np.abs(points[:, 1]), points[:, 2]])
    knob = ellipsoid(folded, (89, 7.5, 9.7), (10.5, 10.0, 10.5))
    shape = smooth_union(smooth_union(shaft, head, 10.0), knob, 6.0)
    return smooth_intersection(shape, -points[:, 2], 2.0)
