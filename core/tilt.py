"""How far to the side a tool may push a point of the surface.

What a sphere does to a linear body when it is pressed about as deep as its radius is not what it
does to a real one: the points round it, pushed aside without resistance of their own, slide off
round its equator, the force falls, and the tool is suddenly inside. So the direction of a push
is held near the inward normal of the surface at rest. A signed distance is the greatest separation
n x - h(n) among all directions n, with h the support function of the tool (its farthest reach along
n); the one used here is the greatest among the directions within the limit. That is the distance to
the tool grown by a cone: a sphere widens into the cone that touches it at the limit. It is convex,
and its gradient is that direction, so the force is still the slope of an energy. Where no point
reaches the limit, below a depth of about half a sphere's radius, the tool's shape is exact.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from .contact_points import ContactPoints
from .tet_mesh import TetMesh

# Largest angle between a push and the inward normal of a face that the point belongs to.
MOST_TILT = np.radians(50.0)

# Angles at which the circle of directions at the limit is looked at first.
TURNS = 24

# Core points that can be nearest at once on that circle, of those nearest where it was looked at.
MOST_AT_ONCE = 8

# No push leads out of the body, whatever faces meet.
LARGEST_LIMIT = np.radians(100.0)


def tilt_limits(mesh: TetMesh, points: ContactPoints) -> NDArray[np.float64]:
    """Largest angle (P,), radians, between a push on each point and its own inward normal.

    At an edge or a corner of the body the point's normal is a mean; a push along any of the faces
    that meet there is as good.
    """
    touched = _faces_of(mesh, points).tocoo()
    i, j, k = (mesh.nodes[mesh.surface_triangles[:, corner]] for corner in range(3))
    faces = np.cross(j - i, k - i)
    faces /= np.linalg.norm(faces, axis=1)[:, None]
    cosines = np.einsum("mx,mx->m", points.normals[touched.row], faces[touched.col])
    least = np.ones(len(points))
    np.minimum.at(least, touched.row, cosines)
    limits: NDArray[np.float64] = MOST_TILT + np.arccos(np.clip(least, -1.0, 1.0))
    return np.minimum(limits, LARGEST_LIMIT)


def held_tilt(
    distances: NDArray[np.float64],
    normals: NDArray[np.float64],
    offsets: NDArray[np.float64],
    inward: NDArray[np.float64],
    limits: NDArray[np.float64],
    radius: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances (p,) and normals (p, 3) of a tool held within ``limits`` (p,) of ``inward`` (p, 3).

    Parameters
    ----------
    distances, normals : of the tool as it is.
    offsets : (p, k, 3), from each of the tool's core points to the points.
    radius : the tool's.
    """
    cosines = np.clip(np.einsum("px,px->p", normals, inward), -1.0, 1.0)
    held = np.flatnonzero(np.arccos(cosines) > limits)
    distances, normals = distances.copy(), normals.copy()
    if held.size:
        greatest, directions = _greatest_on_limit(offsets[held], inward[held], limits[held])
        distances[held], normals[held] = greatest - radius, directions
    return distances, normals


def _greatest_on_limit(
    offsets: NDArray[np.float64], inward: NDArray[np.float64], limits: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Greatest separation (p,) from core points among directions at the limit, and that direction.

    Along the circle of directions the separation from each core point is a sinusoid; that from
    their hull is the least of them. So it is greatest at the peak of one or where two cross.
    """
    first, second = _across(inward)
    mean = np.cos(limits)[:, None] * np.einsum("pkx,px->pk", offsets, inward)
    sine = np.sin(limits)[:, None]
    along = sine * np.einsum("pkx,px->pk", offsets, first)
    aside = sine * np.einsum("pkx,px->pk", offsets, second)
    turns = np.arange(TURNS) * (2.0 * np.pi / TURNS)
    sampled = _sinusoids(mean, along, aside, np.broadcast_to(turns, (len(limits), TURNS)))
    best = sampled.min(axis=1).argmax(axis=1)
    rows = np.arange(len(limits))[:, None]
    # Of many core points those that are least near the best turn.
    few = np.argsort(sampled[rows[:, 0], :, best], axis=1, kind="stable")[:, :MOST_AT_ONCE]
    turns = _turning_points(mean[rows, few], along[rows, few], aside[rows, few])
    greatest = _sinusoids(mean, along, aside, turns).min(axis=1)
    chosen = greatest.argmax(axis=1)
    turn = turns[rows[:, 0], chosen, None]
    directions = (
        np.cos(limits)[:, None] * inward
        + sine * np.cos(turn) * first
        + sine * np.sin(turn) * second
    )
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
    """Two unit vectors (p, 3) each, across unit ``axes`` (p, 3) and each other."""
    least = np.eye(3)[np.abs(axes).argmin(axis=1)]
    first = np.cross(axes, least)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(axes, first)


def _faces_of(mesh: TetMesh, points: ContactPoints) -> csr_array:
    """Which surface triangles (S,) each point (P,) lies in, on an edge or corner of: (P, S)."""
    triangles = mesh.surface_local_triangles
    count, nodes = len(triangles), len(mesh.surface_nodes)
    has = coo_array(
        (np.ones(3 * count), (np.repeat(np.arange(count), 3), triangles.reshape(-1))),
        shape=(count, nodes),
    ).tocsr()
    carried = points.alphas > 0.0
    row, corner = np.nonzero(carried)
    needs = coo_array(
        (np.ones(len(row)), (row, triangles[points.triangles[row], corner])),
        shape=(len(points), nodes),
    ).tocsr()
    shared = (needs @ has.T).tocoo()
    whole = shared.data == carried.sum(axis=1)[shared.row]
    return coo_array(
        (np.ones(int(whole.sum())), (shared.row[whole], shared.col[whole])),
        shape=shared.shape,
    ).tocsr()
