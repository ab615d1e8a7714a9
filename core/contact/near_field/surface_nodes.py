"""Edge lengths, neighbours and softness of the surface nodes of a body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...body.soft_body import SoftBody
from ...stiffness.formulation import SMOOTHED
from ...stiffness.strain_smoothing import TET_EDGES
from .far_side import far_side

# Moduli that differ by the first factor are of one material, by the second of two.
ONE_MATERIAL = (4.0, 40.0)

# Smoothed elements give way too far up to three of the surface's edges from a force: by 3 % of a
# half-space at two edges on a ball of fTetWild's, by 9 % where what is beneath is half as fine as
# the surface. So where it is safe distances are told in lengths that are wider by this factor.
WIDER = 1.2

# It is safe where all normals within so many edges, as far as a ring reaches then, have products of
# at least the second number; below the first it is not: on parts as thin as the ring what is close
# together would no longer be positive definite. Nor is it where the body is less than so many edges
# thick, from the second number on it is wholly: what a layer does otherwise than a half-space is no
# plane on the ring.
LOOKED_AROUND = 3.4
EVEN = (0.5, 0.8)
THICK = (6.0, 10.0)


def mean_edges(body: SoftBody) -> NDArray[np.float64]:
    """Mean length of the surface edges at each surface node, (s,), metres."""
    mesh = body.mesh
    triangles, places = mesh.surface_local_triangles, mesh.nodes[mesh.surface_nodes]
    ahead = np.roll(triangles, -1, axis=1)
    lengths = np.linalg.norm(places[triangles] - places[ahead], axis=2).ravel()
    # Every edge of a closed surface is met twice, once from either side.
    count = np.bincount(triangles.ravel(), minlength=len(places))
    mean: NDArray[np.float64] = np.bincount(triangles.ravel(), lengths, len(places)) / count
    return mean


def resolved_lengths(body: SoftBody, normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """Length at each surface node, (s,), metres, in which distances to others are told.

    The surface's mean edge there. For smoothed elements, where the surface around is even and the
    body thick, it is the mean edge of all tetrahedra at the node, and wider (:data:`WIDER`): they
    err as far around a force as the elements beneath it are wide. ``normals`` (s, 3) are outward
    unit normals.
    """
    edges = mean_edges(body)
    if body.formulation != SMOOTHED:
        return edges
    a, b = pairs_within(body.mesh.nodes[body.mesh.surface_nodes], LOOKED_AROUND * edges)
    alike, least = np.einsum("kx,kx->k", normals[a], normals[b]), np.ones(len(edges))
    np.minimum.at(least, a, alike)
    np.minimum.at(least, b, alike)
    low, high = EVEN
    share = np.clip((least - low) / (high - low), 0.0, 1.0)
    share *= 1.0 - far_side(body.mesh, edges, THICK).weights.sum(axis=1)
    wider = np.maximum(WIDER * _tetrahedron_edges(body), edges)
    lengths: NDArray[np.float64] = edges + share * (wider - edges)
    return lengths


def _tetrahedron_edges(body: SoftBody) -> NDArray[np.float64]:
    """Mean length of the edges of all tetrahedra at each surface node, (s,), metres."""
    mesh = body.mesh
    ends = np.unique(np.sort(mesh.tets[:, TET_EDGES].reshape(-1, 2), axis=1), axis=0)
    lengths = np.linalg.norm(mesh.nodes[ends[:, 0]] - mesh.nodes[ends[:, 1]], axis=1)
    total = np.bincount(ends.ravel(), np.repeat(lengths, 2), len(mesh.nodes))
    count = np.bincount(ends.ravel(), minlength=len(mesh.nodes))
    mean: NDArray[np.float64] = total[mesh.surface_nodes] / count[mesh.surface_nodes]
    return mean


def pairs_within(
    places: NDArray[np.float64], reach: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs a < b of places (s, 3) no farther apart than the mean of their reaches (s,)."""
    tree = cKDTree(places)
    found = tree.query_ball_point(places, reach)
    a = np.repeat(np.arange(len(places)), [len(one) for one in found])
    b = np.concatenate([np.asarray(one, dtype=np.int64) for one in found])
    a, b = np.minimum(a, b), np.maximum(a, b)
    codes = np.unique(a[a != b] * len(places) + b[a != b])
    a, b = np.divmod(codes, len(places))
    near = np.linalg.norm(places[a] - places[b], axis=1) <= 0.5 * (reach[a] + reach[b])
    return a[near], b[near]


def surface_softness(body: SoftBody) -> NDArray[np.float64]:
    """1 over the factor of Young's modulus at each surface node, (s,): mean of its tetrahedra."""
    mesh = body.mesh
    if body.young_scale is None:
        return np.ones(len(mesh.surface_nodes))
    weight = np.repeat(mesh.tet_volumes, 4)
    stiff = np.bincount(mesh.tets.ravel(), weight * np.repeat(body.young_scale, 4))
    volume = np.bincount(mesh.tets.ravel(), weight)
    softness: NDArray[np.float64] = (volume / stiff)[mesh.surface_nodes]
    return softness


def of_one_material(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Degree to which two moduli or softnesses (k,) are of one material, (k,), 0 to 1.

    Across a bone's border in flesh a body is no half-space, of neither of the two.
    """
    alike, other = np.log(ONE_MATERIAL)
    share: NDArray[np.float64] = np.clip(
        (other - np.abs(np.log(first / second))) / (other - alike), 0.0, 1.0
    )
    return share


def surface_evenness(body: SoftBody) -> NDArray[np.float64]:
    """Degree to which all tetrahedra at each surface node are of one material, (s,), 0 to 1."""
    mesh = body.mesh
    if body.young_scale is None:
        return np.ones(len(mesh.surface_nodes))
    scale = np.repeat(body.young_scale, 4)
    least, most = np.full(len(mesh.nodes), np.inf), np.zeros(len(mesh.nodes))
    np.minimum.at(least, mesh.tets.ravel(), scale)
    np.maximum.at(most, mesh.tets.ravel(), scale)
    return of_one_material(most[mesh.surface_nodes], least[mesh.surface_nodes])
