"""How far to the side a tool may push a point of the surface.

What a sphere does to a linear body when it is pressed about as deep as its radius is not what it
does to a real one: the points round it, pushed aside without resistance of their own, slide off
round its equator, the force falls, and the tool is suddenly inside. So a push is held near the
direction that the pressed surface faces. A signed distance is the greatest separation n x - h(n)
among all directions n, with h the support function of the tool (its farthest reach along n); the
one used here is the greatest among the directions within the limit. That is the distance to the
tool grown by a cone: a sphere widens into the cone that touches it at the limit. It is convex, and
its gradient is that direction. Where no push reaches the limit, below a depth of about half a
sphere's radius, the tool's shape is exact.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# Largest angle between a push and the direction against which an even surface is pressed, and by
# how much more where the pressed points face different ways: at most this, were they all opposed.
MOST_TILT = np.radians(50.0)
MORE_WHERE_UNEVEN = np.radians(100.0)

# Angles at which the circle of directions at the limit is looked at first.
TURNS = 24

# Core points that can be nearest at once on that circle, of those nearest where it was looked at.
MOST_AT_ONCE = 8


def hold(
    forces: NDArray[np.float64], normals: NDArray[np.float64]
) -> tuple[NDArray[np.float64], float]:
    """The direction (3,) that pushes are held near, and within what angle, radians, after the last
    ``forces`` (p, 3) on points with outward normals (p, 3). Where there were none it is nowhere.

    Only forces into the body count: where a tool reaches the far side of a thin part it pushes
    that outwards, and the part would else be felt turned round.
    """
    into = np.maximum(-np.einsum("px,px->p", forces, normals), 0.0)
    facing = into @ normals
    length, most = float(np.linalg.norm(facing)), float(into.sum())
    if length == 0.0:
        return np.array([0.0, 0.0, 1.0]), np.pi
    return -facing / length, float(MOST_TILT + MORE_WHERE_UNEVEN * (1.0 - length / most))


def held_tilt(
    distances: NDArray[np.float64],
    normals: NDArray[np.float64],
    offsets: NDArray[np.float64],
    inward: NDArray[np.float64],
    limit: float,
    radius: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances (p,) and normals (p, 3) of a tool held within ``limit`` of ``inward`` (3,).

    Parameters
    ----------
    distances, normals : of the tool as it is.
    offsets : (p, k, 3), from each of the tool's core points to the points.
    radius : the tool's.
    """
    held = np.flatnonzero(np.arccos(np.clip(normals @ inward, -1.0, 1.0)) > limit)
    distances, normals = distances.copy(), normals.copy()
    if held.size:
        greatest, directions = _greatest_on_limit(offsets[held], inward, limit)
        distances[held], normals[held] = greatest - radius, directions
    return distances, normals


def _greatest_on_limit(
    offsets: NDArray[np.float64], inward: NDArray[np.float64], limit: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Greatest separation (p,) from core points among directions at the limit, and that direction.

    Along the circle of directions the separation from each core point is a sinusoid; that from
    their hull is the least of them. So it is greatest at the peak of one or where two cross.
    """
    first, second = _across(inward)
    cosine, sine = np.cos(limit), np.sin(limit)
    mean, along, aside = (
        cosine * (offsets @ inward),
        sine * (offsets @ first),
        sine * (offsets @ second),
    )
    turns = np.arange(TURNS) * (2.0 * np.pi / TURNS)
    sampled = _sinusoids(mean, along, aside, np.broadcast_to(turns, (len(offsets), TURNS)))
    best = sampled.min(axis=1).argmax(axis=1)
    rows = np.arange(len(offsets))[:, None]
    # Of many core points those that are least near the best turn.
    few = np.argsort(sampled[rows[:, 0], :, best], axis=1, kind="stable")[:, :MOST_AT_ONCE]
    turns = _turning_points(mean[rows, few], along[rows, few], aside[rows, few])
    greatest = _sinusoids(mean, along, aside, turns).min(axis=1)
    chosen = greatest.argmax(axis=1)
    turn = turns[rows[:, 0], chosen, None]
    directions = cosine * inward + sine * np.cos(turn) * first + sine * np.sin(turn) * second
    return greatest[rows[:, 0], chosen], directions


def _turning_points(
    mean: NDArray[np.float64], along: NDArray[np.float64], aside: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Angles (p, q) of the peaks of sinusoids (p, k) and of the places where two of them cross."""
    peaks = np.arctan2(aside, along)
    i, j = np.triu_indices(mean.shape[1], 1)
    a, b = along[:, i] - along[:, j], aside[:, i] - aside[:, j]
    height = np.hypot(a, b)
    level = np.divide(mean[:, j] - mean[:, i], height, out=np.zeros_like(a), where=height > 0.0)
    middle, apart = np.arctan2(b, a), np.arccos(np.clip(level, -1.0, 1.0))
    return np.concatenate([peaks, middle + apart, middle - apart], axis=1)


def _sinusoids(
    mean: NDArray[np.float64],
    along: NDArray[np.float64],
    aside: NDArray[np.float64],
    turns: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Values (p, k, q) of sinusoids (p, k) at angles (p, q)."""
    cosines, sines = np.cos(turns)[:, None, :], np.sin(turns)[:, None, :]
    values: NDArray[np.float64] = (
        mean[:, :, None] + along[:, :, None] * cosines + aside[:, :, None] * sines
    )
    return values


def _across(axis: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Two unit vectors across a unit ``axis`` (3,) and each other."""
    first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    first /= np.linalg.norm(first)
    return first, np.cross(axis, first)
