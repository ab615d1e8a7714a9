"""Statically determinate hold of a body without pins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_array, csr_array

from ...mesh.tet_mesh import TetMesh


def held(mesh: TetMesh, stiffness: csr_array) -> csr_array:
    """Stiffness with six springs to the ground: three at a node, two at another, one at a third.

    The nodes lie far apart. Six springs that stop all rigid motion cannot hold loads that balance:
    their forces are zero, however firm they are; they are as firm as a node of the body.

    Parameters
    ----------
    mesh : the body, of one piece.
    stiffness : (3N, 3N) of all nodes.
    """
    first, second, third = nodes = _far_apart(mesh.nodes)
    along = _unit(mesh.nodes[second] - mesh.nodes[first])
    normal = _unit(np.cross(along, mesh.nodes[third] - mesh.nodes[first]))
    firmness = float(np.median(stiffness.diagonal()))
    springs = firmness * np.array(
        [np.eye(3), np.eye(3) - np.outer(along, along), np.outer(normal, normal)]
    )
    order = np.argsort(nodes)
    starts = np.searchsorted(np.sort(nodes), np.arange(len(mesh.nodes) + 1))
    hold = bsr_array((springs[order], np.array(nodes)[order], starts), shape=stiffness.shape)
    firm: csr_array = (stiffness + hold.tocsr()).tocsr()
    return firm


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
