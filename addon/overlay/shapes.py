"""Small shapes for the overlay, shaded on the CPU: Blender's plain shaders have no light."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull

from ...core.contact.tool.tools import Tool

# Vertices (v, 3), colours (v, 4) and triangles (t, 3).
Lit = tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]]

RINGS, SEGMENTS = 16, 32
# Light from the upper left before the viewer, and brightness of the far side.
LIGHT = np.array([-0.4, 0.6, 0.7]) / np.linalg.norm([-0.4, 0.6, 0.7])
AMBIENT = 0.45
# Glass: opacity of a tool in its middle and at its rim.
GLASS, RIM = 0.2, 0.95
# Its highlight: how narrow, and how bright.
SHINE, SHINING = 30, 0.7


@dataclass(frozen=True, eq=False)
class Shape:
    """Shape with vertices (v, 3) of unit size, their normals, and triangles (t, 3)."""

    vertices: NDArray[np.float64]
    normals: NDArray[np.float64]
    triangles: NDArray[np.int32]


def lit(
    shape: Shape,
    place: ArrayLike,
    size: ArrayLike,
    color: ArrayLike,
    view_axes: NDArray[np.float64],
    turn: NDArray[np.float64] | None = None,
) -> Lit:
    """Shape at ``place``, lit for the view."""
    rotation = np.eye(3) if turn is None else turn
    vertices = np.asarray(place) + (shape.vertices * np.asarray(size)) @ rotation.T
    brightness = AMBIENT + (1.0 - AMBIENT) * np.clip(
        shape.normals @ rotation.T @ view_axes.T @ LIGHT, 0.0, 1.0
    )
    rgba = np.tile(np.asarray(color, dtype=np.float32), (len(vertices), 1))
    rgba[:, :3] *= brightness[:, None].astype(np.float32)
    return vertices.astype(np.float32), rgba, shape.triangles


def glass(
    shape: Shape,
    place: ArrayLike,
    size: float,
    color: ArrayLike,
    view_axes: NDArray[np.float64],
    turn: NDArray[np.float64],
) -> Lit:
    """Transparent shape, its outline stronger than its middle, with a highlight."""
    vertices, rgba, triangles = lit(shape, place, size, color, view_axes, turn)
    normals = shape.normals @ turn.T @ view_axes.T
    halfway = LIGHT + np.array([0.0, 0.0, 1.0])
    halfway /= np.linalg.norm(halfway)
    shine = SHINING * np.clip(normals @ halfway, 0.0, 1.0)[:, None] ** SHINE
    opacity = GLASS + (RIM - GLASS) * (1.0 - np.abs(normals[:, 2:])) ** 3
    rgba[:, :3] += shine * (1.0 - rgba[:, :3])
    rgba[:, 3:] *= np.maximum(opacity, shine)
    return vertices, rgba, triangles


def tool_shape(tool: Tool) -> Shape:
    """Surface of a tool, metres in its own frame: the hull of balls at its core points."""
    points = (tool.core[:, None] + tool.radius * SPHERE.vertices).reshape(-1, 3)
    normals = np.tile(SPHERE.vertices, (len(tool.core), 1))
    hull = ConvexHull(points)
    outward = np.einsum(
        "fx,fx->f",
        np.cross(
            points[hull.simplices[:, 1]] - points[hull.simplices[:, 0]],
            points[hull.simplices[:, 2]] - points[hull.simplices[:, 0]],
        ),
        hull.equations[:, :3],
    )
    triangles = np.where((outward > 0.0)[:, None], hull.simplices, hull.simplices[:, ::-1])
    used, renumbered = np.unique(triangles, return_inverse=True)
    return Shape(points[used], normals[used], renumbered.reshape(-1, 3).astype(np.int32))


def _grid_triangles(rings: int) -> NDArray[np.int32]:
    """Triangles between ``rings`` + 1 rings of SEGMENTS vertices each, wound outward."""
    ring, segment = np.meshgrid(np.arange(rings), np.arange(SEGMENTS), indexing="ij")
    here, beside = ring * SEGMENTS + segment, ring * SEGMENTS + (segment + 1) % SEGMENTS
    above, across = here + SEGMENTS, beside + SEGMENTS
    quads = np.stack([here, beside, across, here, across, above], axis=-1)
    return quads.reshape(-1, 3).astype(np.int32)


def _circle() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    angle = 2.0 * np.pi * np.arange(SEGMENTS) / SEGMENTS
    return np.cos(angle), np.sin(angle)


def _sphere() -> Shape:
    cosine, sine = _circle()
    height = -np.cos(np.pi * np.arange(RINGS + 1) / RINGS)[:, None]
    radius = np.sqrt(np.maximum(1.0 - height**2, 0.0))
    flat = np.broadcast_to(height, (RINGS + 1, SEGMENTS))
    points = np.stack([radius * cosine, radius * sine, flat], axis=-1).reshape(-1, 3)
    return Shape(points, points, _grid_triangles(RINGS))


def _cone() -> Shape:
    """Cone along +Z, from a base of radius 1 at 0 to the tip at 1."""
    cosine, sine = _circle()
    zero, one = np.zeros(SEGMENTS), np.ones(SEGMENTS)
    rings = [(zero, zero, zero), (cosine, sine, zero), (cosine, sine, zero), (zero, zero, one)]
    points = np.stack([np.stack(ring, axis=-1) for ring in rings]).reshape(-1, 3)
    down = np.tile([0.0, 0.0, -1.0], (2 * SEGMENTS, 1))
    aside = np.tile(np.stack([cosine, sine, 0.5 * one], axis=-1), (2, 1))
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    return Shape(points, np.concatenate([down, aside]), _grid_triangles(3))


SPHERE, CONE = _sphere(), _cone()
