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

A tool may touch parts that face different ways, a head and the ear beside it. So a point may
besides be pushed near the direction that it faces itself, unless the tool has passed through a
part: then what it meets on the far side would push it on.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# Largest angle between a push and the direction against which an even surface is pressed, and by
# how much more where the pressed points face different ways: at most this, were they all opposed.
MOST_TILT = np.radians(50.0)
MORE_WHERE_UNEVEN = np.radians(100.0)

# A push that goes out of the body by more than this cosine has come through a part; one beside the
# tool may go out a little on any curved surface.
OUTWARD = 0.5

# Angles at which the circle of directions at the limit is looked at first.
TURNS = 24

# Core points that can be nearest at once on that circle, of those nearest where it was looked at.
MOST_AT_ONCE = 8


@dataclass(frozen=True, eq=False)
class Hold:
    """The directions that pushes are held within.

    Attributes
    ----------
    inward : float64 (3,), what all pushes are held near, unit vector.
    limit : how near, radians.
    own : whether each may be near the direction that its own point faces instead.
    """

    inward: NDArray[np.float64]
    limit: float
    own: bool

    def allows(
        self, directions: NDArray[np.float64], facing: NDArray[np.float64]
    ) -> NDArray[np.bool_]:
        """Which of some unit directions (p, 3) points with outward normals ``facing`` (p, 3) may be
        pushed along.
        """
        along = np.clip(directions @ self.inward, -1.0, 1.0)
        near_all: NDArray[np.bool_] = along >= np.cos(self.limit)
        if not self.own:
            return near_all
        near_own: NDArray[np.bool_] = -np.einsum("px,px->p", directions, facing) >= np.cos(
            MOST_TILT
        )
        return near_all | near_own


def hold(forces: NDArray[np.float64], facing: NDArray[np.float64]) -> Hold:
    """What pushes are held within after the last ``forces`` (p, 3) on points with outward normals
    ``facing`` (p, 3). Where there were none it is all directions.

    Only forces into the body count: where a tool reaches the far side of a thin part it pushes
    that outwards, and the part would else be felt turned round.
    """
    outward = np.einsum("px,px->p", forces, facing)
    into = np.maximum(-outward, 0.0)
    faced = into @ facing
    length, most = float(np.linalg.norm(faced)), float(into.sum())
    if length == 0.0:
        return Hold(np.array([0.0, 0.0, 1.0]), np.pi, own=False)
    limit = float(MOST_TILT + MORE_WHERE_UNEVEN * (1.0 - length / most))
    own = not (outward > OUTWARD * np.linalg.norm(forces, axis=1)).any()
    return Hold(-faced / length, limit, own)


def held_tilt(
    distances: NDArray[np.float64],
    normals: NDArray[np.float64],
    offsets: NDArray[np.float64],
    facing: NDArray[np.float64],
    within: Hold,
    radius: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances (p,) and normals (p, 3) of a tool held ``within`` some directions.

    Parameters
    ----------
    distances, normals : of the tool as it is.
    offsets : (p, k, 3), from each of the tool's core points to the points.
    facing : (p, 3), outward normals of the body at the points.
    radius : the tool's.
    """
    held = np.flatnonzero(~within.allows(normals, facing))
    distances, normals = distances.copy(), normals.copy()
    if not held.size:
        return distances, normals
    inward = np.broadcast_to(within.inward, (len(held), 3))
    greatest, directions = _greatest_on_limit(offsets[held], inward, within.limit)
    if within.own:
        own, along_own = _greatest_on_limit(offsets[held], -facing[held], MOST_TILT)
        directions = np.where((own > greatest)[:, None], along_own, directions)
        greatest = np.maximum(own, greatest)
    distances[held], normals[held] = greatest - radius, directions
    return distances, normals


def _greatest_on_limit(
    offsets: NDArray[np.float64], inward: NDArray[np.float64], limit: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Greatest separation (p,) from core points among directions at the limit from ``inward``
    (p, 3), and that direction (p, 3).

    Along the circle of directions the separation from each core point is a sinusoid; that from
    their hull is the least of them. So it is greatest at the peak of one or where two cross.
    """
    first, second = _across(inward)
    cosine, sine = np.cos(limit), np.sin(limit)
    mean, along, aside = (
        cosine * np.einsum("pkx,px->pk", offsets, inward),
        sine * np.einsum("pkx,px->pk", offsets, first),
        sine * np.einsum("pkx,px->pk", offsets, second),
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


def _across(axes: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Two unit vectors (p, 3) across unit ``axes`` (p, 3) and each other."""
    first = np.cross(axes, np.eye(3)[np.abs(axes).argmin(axis=1)])
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(axes, first)
