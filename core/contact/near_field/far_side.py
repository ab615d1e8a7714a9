"""Opposite side of a body at each node of its surface, where the body is thin."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...mesh.tet_mesh import TetMesh
from .surface_shape import face_vectors, unit

# A ray leaves the body at a face whose normal has at least this product with its direction.
LEAVING = 0.2

# How far below the surface rays begin, in shares of the mean edge: from a rim they would else run
# along the surface.
PULLED_IN = 1e-3

# Of so many parts rays are looked around: balls around long ones hold much that is far from them.
PARTS = 6

# By how much of a triangle a ray may miss it: rays along edges and through nodes count.
SLACK = 1e-9


@dataclass(frozen=True, eq=False)
class FarSide:
    """Place across the body from each of its s surface nodes.

    Attributes
    ----------
    nodes : int64 (s, 3), surface-local nodes of the triangle there.
    weights : float64 (s, 3), area coordinates in it, times 1 where the body is thin and less, down
        to 0, where it is not.
    """

    nodes: NDArray[np.int64]
    weights: NDArray[np.float64]


def far_side(mesh: TetMesh, edges: NDArray[np.float64], reach: tuple[float, float]) -> FarSide:
    """Go through the body from each node, against the mean normal of those faces where it is thin.

    Parameters
    ----------
    edges : (s,), mean length of the surface's edges at the surface nodes, metres.
    reach : thickness in edges up to which a body is thin, and from which on it is not at all.
    """
    corners, places = mesh.nodes[mesh.surface_triangles], mesh.nodes[mesh.surface_nodes]
    triangles = mesh.surface_local_triangles
    outward = face_vectors(mesh)
    normals = unit(outward)
    from_faces = _Rays(corners.mean(axis=1), -normals, reach[1] * edges[triangles].mean(axis=1))
    thin = _thinness(_first_exits(corners, normals, from_faces)[2] / from_faces.lengths, reach)
    directions, inward = np.zeros_like(places), np.zeros_like(places)
    for corner in range(3):
        np.add.at(directions, triangles[:, corner], -thin[:, None] * outward)
        np.add.at(inward, triangles[:, corner], -outward)
    chosen = np.flatnonzero((directions * inward).sum(axis=1) > 0.0)
    begin = PULLED_IN * edges[chosen, None] * unit(inward[chosen])
    rays = _Rays(places[chosen] + begin, unit(directions[chosen]), reach[1] * edges[chosen])
    triangle, alphas, depths = _first_exits(corners, normals, rays)
    nodes, weights = np.zeros((len(places), 3), np.int64), np.zeros((len(places), 3))
    nodes[chosen] = triangles[triangle]
    weights[chosen] = _thinness(depths / rays.lengths, reach)[:, None] * alphas
    return FarSide(nodes, weights)


@dataclass(frozen=True, eq=False)
class _Rays:
    """Rays from ``places`` (r, 3) along unit ``directions`` (r, 3), ``lengths`` (r,) metres far."""

    places: NDArray[np.float64]
    directions: NDArray[np.float64]
    lengths: NDArray[np.float64]


def _thinness(depths: NDArray[np.float64], reach: tuple[float, float]) -> NDArray[np.float64]:
    """Thinness, 1 to 0, for depths (k,) in shares of the farther reach."""
    thinness: NDArray[np.float64] = np.clip((1.0 - depths) / (1.0 - reach[0] / reach[1]), 0.0, 1.0)
    return thinness


def _first_exits(
    corners: NDArray[np.float64], normals: NDArray[np.float64], rays: _Rays
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Triangle (r,) in which each ray first leaves the body, area coordinates (r, 3) there, and how
    far that is (r,), metres, infinity where it does not.
    """
    ray, triangle = _near_pairs(corners, rays)
    leaves = np.einsum("kx,kx->k", normals[triangle], rays.directions[ray]) > LEAVING
    ray, triangle = ray[leaves], triangle[leaves]
    depth, alpha = _crossings(corners[triangle], rays.places[ray], rays.directions[ray])
    met = (alpha >= -SLACK).all(axis=1) & (depth > 0.0) & (depth < rays.lengths[ray])
    ray, triangle, depth, alpha = ray[met], triangle[met], depth[met], alpha[met]
    # Of several triangles at one depth the one of least number.
    order = np.lexsort((triangle, depth, ray))
    seen, first = np.unique(ray[order], return_index=True)
    taken, count = order[first], len(rays.places)
    triangles, alphas = np.zeros(count, np.int64), np.zeros((count, 3))
    depths = np.full(count, np.inf)
    triangles[seen], depths[seen] = triangle[taken], depth[taken]
    inside = np.maximum(alpha[taken], 0.0)
    alphas[seen] = inside / inside.sum(axis=1, keepdims=True)
    return triangles, alphas, depths


def _near_pairs(
    corners: NDArray[np.float64], rays: _Rays
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of ray and triangle that may meet, (k,) each."""
    centres = corners.mean(axis=1)
    radii = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    parts = np.repeat(np.arange(len(rays.places)), PARTS)
    ways = np.tile((np.arange(PARTS) + 0.5) / PARTS, len(rays.places)) * rays.lengths[parts]
    middles = rays.places[parts] + ways[:, None] * rays.directions[parts]
    reach = 0.5 / PARTS * rays.lengths[parts] + radii.max()
    found = cKDTree(centres).query_ball_point(middles, reach)
    numbers = np.fromiter(chain.from_iterable(found), np.int64)
    # Parts of a ray find one triangle more than once.
    pairs = np.unique(np.repeat(parts, [len(one) for one in found]) * len(corners) + numbers)
    ray, triangle = np.divmod(pairs, len(corners))
    # Only those that the line passes.
    offset, along = centres[triangle] - rays.places[ray], rays.directions[ray]
    aside = offset - np.einsum("kx,kx->k", offset, along)[:, None] * along
    near = np.einsum("kx,kx->k", aside, aside) <= radii[triangle] ** 2 * (1.0 + SLACK)
    return ray[near], triangle[near]


def _crossings(
    corners: NDArray[np.float64], places: NDArray[np.float64], directions: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances of rays (k,) to the planes of triangles (k, 3, 3), metres, and area coordinates
    (k, 3) there. No ray may be parallel to its plane.

    T. Möller and B. Trumbore, J. Graphics Tools 2 (1997), 21.
    """
    along, across = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    turned = np.cross(directions, across)
    inverse = 1.0 / np.einsum("kx,kx->k", along, turned)
    offset = places - corners[:, 0]
    b = np.einsum("kx,kx->k", offset, turned) * inverse
    swept = np.cross(offset, along)
    c = np.einsum("kx,kx->k", directions, swept) * inverse
    depth = np.einsum("kx,kx->k", across, swept) * inverse
    return depth, np.column_stack([1.0 - b - c, b, c])
