"""Signed distances of the few solids the plush mouse is put together from."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Points = NDArray[np.float64]
Distances = NDArray[np.float64]


def ellipsoid(points: Points, centre: ArrayLike, radii: ArrayLike) -> Distances:
    """Distance (first order) of points (m, 3) to an ellipsoid; exact on its surface."""
    radii = np.asarray(radii, dtype=np.float64)
    offset = (points - np.asarray(centre)) / radii
    near = np.linalg.norm(offset, axis=1)
    slope = np.linalg.norm(offset / radii, axis=1)
    return near * (near - 1.0) / np.maximum(slope, 1e-9)


def round_cone(
    points: Points, start: ArrayLike, end: ArrayLike, start_radius: float, end_radius: float
) -> Distances:
    """Distance of points (m, 3) to spheres swept from `start` to `end` with a changing radius."""
    a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    axis = b - a
    t = np.clip((points - a) @ axis / (axis @ axis), 0.0, 1.0)
    gap = np.linalg.norm(points - a - t[:, None] * axis, axis=1)
    return gap - (start_radius + t * (end_radius - start_radius))


def dish_frame(
    points: Points, centre: ArrayLike, normal: ArrayLike, bend: float
) -> tuple[Distances, Distances]:
    """Radius and height (both (m,)) over a bowl that opens along `normal`; `bend` is its radius."""
    n = np.asarray(normal, dtype=np.float64)
    n = n / np.linalg.norm(n)
    offset = points - np.asarray(centre)
    height = offset @ n
    radius = np.linalg.norm(offset - height[:, None] * n, axis=1)
    return radius, height - radius**2 / (2.0 * bend)


def rounded_disc(
    radius: Distances, height: Distances, disc_radius: float, half_thickness: float
) -> Distances:
    """Distance to a disc with a round rim, in the coordinates of `dish_frame`."""
    return np.hypot(np.maximum(radius - disc_radius + half_thickness, 0.0), height) - half_thickness


def smooth_union(a: Distances, b: Distances, width: float) -> Distances:
    """The smaller of two distances, blended over `width` (quadratic fillet)."""
    blend = np.maximum(width - np.abs(a - b), 0.0) / width
    return np.minimum(a, b) - 0.25 * width * blend**2


def smooth_intersection(a: Distances, b: Distances, width: float) -> Distances:
    """The larger of two distances, blended over `width`."""
    return -smooth_union(-a, -b, width)
