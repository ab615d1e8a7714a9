"""Statically determinate hold of a body without pins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_array, csr_array


def held(points: NDArray[np.float64], stiffness: csr_array) -> csr_array:
    """Stiffness (3N, 3N) of all nodes, at ``points`` (N, 3), with :func:`hold`."""
    nodes, springs = hold(points, float(np.median(stiffness.diagonal())))
    starts = np.searchsorted(nodes, np.arange(len(points) + 1))
    ground = bsr_array((springs, nodes, starts), shape=stiffness.shape)
    firm: csr_array = (stiffness + ground.tocsr()).tocsr()
    return firm


def hold(
    points: NDArray[np.float64], firmness: float
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Six springs to the ground: three at a node, two at another, one at a third.

    The nodes lie far apart. Six springs that stop all rigid motion cannot hold loads that balance:
    their forces are zero, however firm they are.

    Parameters
    ----------
    points : (N, 3), nodes of a body of one piece.
    firmness : of each spring, as of a node of the body.

    Returns
    -------
    the nodes (3,), ascending, and their springs' stiffness (3, 3, 3).
    """
    first, second, third = nodes = _far_apart(points)
    along = _unit(points[second] - points[first])
    normal = _unit(np.cross(along, points[third] - points[first]))
    springs = firmness * np.array(
        [np.eye(3), np.eye(3) - np.outer(along, along), np.outer(normal, normal)]
    )
    order = np.argsort(nodes)
    return np.array(nodes, dtype=np.int64)[order], springs[order]


def _far_apart(points: NDArray[np.float64]) -> tuple[int, int, int]:
    """Numbers of three points (k, 3) far apart, the third far from the line through the others."""
    first = int(_lengths(points - points.mean(axis=0)).argmax())
    arms = points - points[first]
    second = int(_lengths(arms).argmax())
    third = int(_lengths(np.cross(arms, arms[second])).argmax())
    return first, second, third


def _lengths(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    lengths: NDArray[np.float64] = np.linalg.norm(vectors, axis=1)
    return lengths


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    return vector / np.linalg.norm(vector)
