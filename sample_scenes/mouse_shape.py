"""The plush mouse: 120 mm from nose to rump, head towards +x, sitting on z = 0. No Blender here.

The body is one signed distance field in millimetres; tail, eyes and nose are closed parts of their
own that overlap it. All parts together are one mesh of quads: fTetWild merges them into one solid.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Self

import numpy as np
from distance import (
    Distances,
    Points,
    dish_frame,
    ellipsoid,
    round_cone,
    rounded_disc,
    smooth_intersection,
    smooth_union,
)
from numpy.typing import NDArray
from surface_net import project, surface_net

PIN_HEIGHT = 0.0015  # metres: what lies lower rests on the table
QUAD_SIZE = 2.44  # millimetres
EAR_CENTRE, EAR_NORMAL = np.array([13.0, 21.5, 60.0]), np.array([0.86, 0.42, 0.28])
EAR_RADIUS, EAR_HALF_THICKNESS, EAR_BEND = 17.5, 3.8, 40.0
TAIL_PATH = np.array(
    [[-46, 0, 10], [-66, 2, 6.5], [-83, -8, 4.0], [-88, -28, 3.6], [-74, -46, 3.4],
     [-52, -50, 3.1], [-36, -58, 2.9], [-20, -62, 3.4]], dtype=np.float64
)  # fmt: skip
MIRROR = np.array([1.0, -1.0, 1.0])


class Part(IntEnum):
    """Material slots of the mouse, in order."""

    PLUSH = 0
    FELT = 1
    BEAD = 2


@dataclass(frozen=True)
class QuadMesh:
    """vertices (v, 3) in metres, outward quads (q, 4), part (q,), felt and quilt (v,) in metres.

    `felt` is negative where plush gives way to felt (inner ears, feet), `quilt` positive where
    it is stitched; both are distances from the seam, so that a shader can draw it sharper than
    the quads are.
    """

    vertices: Points
    quads: NDArray[np.int64]
    part: NDArray[np.int64]
    felt: Distances
    quilt: Distances

    @classmethod
    def of_parts(
        cls,
        parts: Sequence[tuple[Points, NDArray[np.int64], Part]],
        felt: Distances,
        quilt: Distances,
    ) -> Self:
        """Of parts in millimetres (vertices, quads), set down on z = 0; the seams are those of the
        vertices of the first one, far from all others.
        """
        offsets = np.cumsum([0] + [len(vertices) for vertices, _, _ in parts])
        vertices = np.concatenate([vertices for vertices, _, _ in parts])
        vertices[:, 2] = np.maximum(vertices[:, 2], 0.0)
        beyond = np.full(len(vertices) - len(felt), 10.0)
        return cls(
            vertices=1e-3 * vertices,
            quads=np.concatenate(
                [quads + first for (_, quads, _), first in zip(parts, offsets, strict=False)]
            ),
            part=np.concatenate([np.full(len(quads), int(part)) for _, quads, part in parts]),
            felt=1e-3 * np.concatenate([felt, beyond]),
            quilt=1e-3 * np.concatenate([quilt, -beyond]),
        )

    @property
    def pinned(self) -> NDArray[np.int64]:
        """Numbers of the vertices that rest on the table."""
        return np.flatnonzero(self.vertices[:, 2] < PIN_HEIGHT)


def mouse() -> QuadMesh:
    """Build the whole mouse, always the same."""
    low, high = np.array([-64.0, -46.0, -4.0]), np.array([68.0, 46.0, 82.0])
    body, body_quads = surface_net(plush, low, high, QUAD_SIZE)
    parts = [(body, body_quads, Part.PLUSH), (*tail(), Part.FELT)]
    for side in (1.0, -1.0):
        eye = np.array([[44.5, side * 14.2, 38.0]])
        seat = project(plush, eye, 0.05, rounds=4)[0] - np.array([0.7, side * 0.5, 0.3])
        parts.append((*ball(seat, np.array([4.4, 4.4, 4.7]), 8), Part.BEAD))
    parts.append((*ball(np.array([61.2, 0.0, 25.0]), np.array([4.4, 5.6, 4.4]), 8), Part.FELT))
    return QuadMesh.of_parts(parts, felt_seam(body), quilt_seam(body))


def plush(points: Points) -> Distances:
    """Signed distance of the body with head, ears and feet, flat underneath (mm)."""
    trunk = ellipsoid(points, (-18, 0, 28), (42, 35, 32))
    head = ellipsoid(points, (24, 0, 33), (27, 26, 25))
    muzzle = round_cone(points, (34, 0, 29), (54, 0, 23.5), 18, 7.5)
    shape = smooth_union(smooth_union(trunk, head, 14.0), muzzle, 10.0)
    mirrored = _folded(points)
    cheek = ellipsoid(mirrored, (42, 9, 23), (13, 10, 10))
    chest = ellipsoid(points, (20, 0, 16), (22, 19, 18))
    haunch = ellipsoid(mirrored, (-24, 22, 20), (25, 17, 20))
    shape = smooth_union(smooth_union(shape, chest, 10.0), cheek, 7.0)
    shape = smooth_union(shape, haunch, 9.0)
    shape = smooth_union(shape, _ear(mirrored), 8.0)
    shape = smooth_union(shape, _feet(mirrored), 4.0)
    return smooth_intersection(shape, -points[:, 2], 3.0)


def felt_seam(points: Points) -> Distances:
    """Signed distance to the seam between plush and felt (mm), negative on the felt side."""
    mirrored = _folded(points)
    radius, height = dish_frame(mirrored, EAR_CENTRE, EAR_NORMAL, EAR_BEND)
    inner_ear = np.maximum(radius - 0.72 * EAR_RADIUS, 1.8 - height)
    trunk = ellipsoid(mirrored, (-18, 0, 28), (42, 35, 32))
    feet = _feet(mirrored) - np.minimum(trunk, 6.0) + 0.6
    return np.minimum(inner_ear, np.where(mirrored[:, 2] < 16.0, feet, 10.0))


def quilt_seam(points: Points) -> Distances:
    """Signed distance to the border of the stitched back (mm): muzzle and ears stay plain."""
    ear = _ear(_folded(points))
    return np.minimum(ear - 3.0, 43.0 - points[:, 0])


def tail(segments: int = 12, rings: int = 64) -> tuple[Points, NDArray[np.int64]]:
    """A tapering closed tube of quads along TAIL_PATH (mm)."""
    path = _spline(TAIL_PATH, rings)
    forward = np.gradient(path, axis=0)
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    side = np.cross(forward, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side, axis=1)[:, None]
    up = np.cross(side, forward)
    t = np.linspace(0.0, 1.0, rings)
    tip = np.sqrt(np.clip((1.0 - t) / 0.04, 0.02, 1.0))
    radius = (4.6 - 1.9 * t) * tip
    angle = 2.0 * np.pi * np.arange(segments) / segments
    spokes = np.cos(angle)[:, None, None] * side + np.sin(angle)[:, None, None] * up
    tube = (path + radius[:, None] * spokes).transpose(1, 0, 2).reshape(-1, 3)
    ring, spoke = np.meshgrid(np.arange(rings - 1), np.arange(segments), indexing="ij")
    after = (spoke + 1) % segments
    a, b = ring * segments + spoke, ring * segments + after
    quads = np.stack([a, a + segments, b + segments, b], axis=-1).reshape(-1, 4)
    caps = [_fan(np.arange(segments)), _fan((rings - 1) * segments + np.arange(segments))[:, ::-1]]
    return tube, np.concatenate([quads, *caps])


def ball(centre: Points, radii: Points, cells: int) -> tuple[Points, NDArray[np.int64]]:
    """An ellipsoid of quads: the surface of a cube of cells^3, blown up."""
    vertices, quads = cube_surface(cells)
    flat = np.tan(0.25 * np.pi * (2.0 * vertices - 1.0))
    return centre + radii * flat / np.linalg.norm(flat, axis=1)[:, None], quads


def cube_surface(cells: int) -> tuple[Points, NDArray[np.int64]]:
    """The closed surface of the unit cube in cells x cells quads a side, vertices shared."""
    corners, quads = [], []
    steps = np.arange(cells + 1)
    u, v = (a.ravel() for a in np.meshgrid(steps, steps, indexing="ij"))
    i, j = (a.ravel() for a in np.meshgrid(steps[:-1], steps[:-1], indexing="ij"))
    for axis in range(3):
        for far in (0, 1):
            side = np.empty((len(u), 3), dtype=np.int64)
            side[:, axis], side[:, (axis + 1) % 3], side[:, (axis + 2) % 3] = far * cells, u, v
            first = len(corners) * len(u) + i * (cells + 1) + j
            quad = np.stack([first, first + cells + 1, first + cells + 2, first + 1], axis=1)
            corners.append(side)
            quads.append(quad if far else quad[:, ::-1])
    vertices, inverse = np.unique(np.concatenate(corners), axis=0, return_inverse=True)
    return vertices / cells, inverse.reshape(-1)[np.concatenate(quads)]


def _folded(points: Points) -> Points:
    """Both halves laid onto y >= 0."""
    return np.column_stack([points[:, 0], np.abs(points[:, 1]), points[:, 2]])


def _ear(mirrored: Points) -> Distances:
    radius, height = dish_frame(mirrored, EAR_CENTRE, EAR_NORMAL, EAR_BEND)
    return rounded_disc(radius, height, EAR_RADIUS, EAR_HALF_THICKNESS)


def _feet(mirrored: Points) -> Distances:
    paw = ellipsoid(mirrored, (38, 16, 5.0), (12, 7.5, 6.5))
    foot = ellipsoid(mirrored, (-2, 32, 5), (16, 8.5, 7))
    return np.minimum(paw, foot)


def _fan(ring: NDArray[np.int64]) -> NDArray[np.int64]:
    """Close a ring of an even number of vertices with a strip of quads."""
    n = len(ring)
    return np.array([ring[[k, k + 1, n - 2 - k, n - 1 - k]] for k in range(n // 2 - 1)])


def _spline(knots: Points, count: int) -> Points:
    """Catmull-Rom curve through `knots` (k, 3) at `count` evenly spread points."""
    padded = np.concatenate([2 * knots[:1] - knots[1:2], knots, 2 * knots[-1:] - knots[-2:-1]])
    pieces = []
    for p0, p1, p2, p3 in zip(padded, padded[1:], padded[2:], padded[3:], strict=False):
        t = np.linspace(0.0, 1.0, 40, endpoint=False)[:, None]
        pieces.append(
            0.5 * (2 * p1 + (p2 - p0) * t + (2 * p0 - 5 * p1 + 4 * p2 - p3) * t**2
                   + (3 * p1 - p0 - 3 * p2 + p3) * t**3)
        )  # fmt: skip
    curve = np.concatenate([*pieces, knots[-1:]])
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    at = np.linspace(0.0, length[-1], count)
    return np.stack([np.interp(at, length, curve[:, i]) for i in range(3)], axis=1)
