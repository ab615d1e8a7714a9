"""A compliance between contact points with which no forces give energy.

The near field takes a body for a half-space around each point. On a part of a few elements, as all
along the edges of a bar, that can add up until forces spread evenly over much of the surface would
give energy. Of such *modes* a body has one or two. With C between all points, and c the least
principal value of each point's own block, or of a half-space's where that is less, as on an ear,

    C' = C + sum_k l_k v_k v_k^T,   l_k and v_k: what C - LEAST_SHARE diag(c) has below zero

so that C' is positive definite by construction, and with it the compliance of any contact among
these points. Each pair changes by its part of a smooth mode; a body that is definite by a margin
does not change at all.
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cholesky, eigh
from scipy.spatial import cKDTree

from ..body.soft_body import SoftBody
from ..contact.near_field.compliance_beneath import NearCorrection, near_correction
from ..contact.near_field.contact_points import ContactPoints, contact_points
from ..contact.near_field.half_space import least_own_displacement
from ..contact.near_field.point_compliance import point_compliance

Array = NDArray[np.float64]

# All forces move contact points by this share at least of what each alone would move its own.
# Cubes and balls have 0.4.
LEAST_SHARE = 0.1
# Of more points than these the modes are found on others, farther apart: modes are smooth.
MOST_POINTS = 500
# And carried over by so many of the nearest, of one side.
NEAREST = 4

_modes: WeakKeyDictionary[SoftBody, tuple[ContactPoints, Array]] = WeakKeyDictionary()


def lifted(body: SoftBody, near: NearCorrection, spacing: float) -> NearCorrection:
    """The same, lifted where energy could be negative; ``spacing`` in metres is that of points few
    enough to find that out.
    """
    points = near.points
    if len(points) <= MOST_POINTS:
        return near.lifted(modes(body, near))
    if body not in _modes:
        few = contact_points(body, spacing, rounded=True)
        _modes[body] = few, modes(body, near_correction(body, few, near.field))
    return near.lifted(carried_over(*_modes[body], points))


def modes(body: SoftBody, near: NearCorrection) -> Array:
    """Ways (P, 3, m) of all points, in root of m / N at 1 Pa, that make the compliance between them
    positive definite.
    """
    everyone = np.arange(len(near.points))
    blocks = point_compliance(body, near.points, everyone, everyone, near)
    own = np.linalg.eigvalsh(blocks[everyone, everyone])[:, 0]
    points = near.points
    alone = least_own_displacement(points.areas, points.normals, body.poisson_ratio)
    least = np.minimum(own, near.softness * alone)
    beyond = as_matrix(blocks)
    beyond[np.diag_indices_from(beyond)] -= LEAST_SHARE * np.repeat(np.maximum(least, 0.0), 3)
    try:
        cholesky(beyond, lower=True, check_finite=False)
    except LinAlgError:
        values, ways = eigh(beyond, subset_by_value=(-np.inf, 0.0))
        lifts: Array = (ways * np.sqrt(-values)).reshape(len(everyone), 3, -1)
        return lifts
    return np.empty((len(everyone), 3, 0))


def carried_over(few: ContactPoints, found: Array, points: ContactPoints) -> Array:
    """Ways (P, 3, m) of ``points`` from those ``found`` (f, 3, m) of ``few``, between the nearest
    of these that look to the same side.
    """
    away, nearest = cKDTree(few.positions).query(points.positions, NEAREST)
    sides = np.einsum("pkx,px->pk", few.normals[nearest], points.normals)
    weights = np.maximum(sides, 1e-6) / (away + 1e-6 * np.sqrt(points.areas)[:, None]) ** 2
    weights /= weights.sum(axis=1, keepdims=True)
    ways: Array = np.einsum("pk,pkxm->pxm", weights, found[nearest])
    return ways


def as_matrix(blocks: Array) -> Array:
    """A symmetric matrix (3 k, 3 k) of blocks (k, k, 3, 3)."""
    whole = blocks.transpose(0, 2, 1, 3).reshape(3 * len(blocks), -1)
    symmetric: Array = 0.5 * (whole + whole.T)
    return symmetric
