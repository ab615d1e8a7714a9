"""What a force at one place of a surface moves another place by, below the fineness of the mesh.

Finite elements cannot resolve what is smaller than they are: how far a node gives way under its own
force depends on the mesh (about as one over its edges), and between nodes all is as smooth as the
elements. But close to a force every smooth surface gives way as a half-space does, H, and what the
body adds to that is smooth. So

    C(x, y) = H(x - y) + sum_ab alpha_a(x) alpha_b(y) (L_ab - H_ab)

where L_ab - H_ab is taken as it is for nodes far enough apart, and for a node itself and its next
neighbours from :mod:`.regular_field`. The part of a force's own cell in H is that of
:mod:`.half_space`. See docs/near-field.md for evidence and limits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from .contact_points import ContactPoints
from .formulation import LINEAR, SMOOTHED
from .half_space import own_displacement
from .pair_blocks import pair_blocks
from .regular_field import BELIEVED, RegularField, facing, half_space_between
from .soft_body import SoftBody
from .solid_angle import FLAT, solid_angles

# Points whose normals have a smaller product than the first are not of one surface, from the second
# on they are wholly: H may reach around an edge, but not through a thin part.
SAME_SURFACE = (-0.5, 0.0)

# A pinned point gives way by this share of what the body's firmest node does under its own force,
# besides what its nodes do: between three pinned nodes no point is the sum of others.
OWN_PINNED = 0.1

# A point with more than the second of these shares of a half-space around it is on a round surface,
# with less than the first on an edge.
ROUND = (0.55, 0.75)

# The exponent that lets a cube's edge and tip give way as in finite elements.
SHARPENING = 1.3

# No point gives way to its own force by less than this share of what it does in a half-space: what
# is left where pins are nearer than the points are apart.
LEAST_OWN = 0.25

# By how much more a point gives way to its own force along the surface than in a half-space. What
# smoothed elements have between neighbours swings, and would else leave blocks of several points
# not positive definite (by up to a third where meshes are coarse and bodies thin).
ACROSS = {LINEAR: 0.0, SMOOTHED: 0.35}

# Pairs of triangles worked on together; bounds memory to some 100 MB.
PAIRS_TOGETHER = 50_000


@dataclass(frozen=True, eq=False)
class NearCorrection:
    """What is to be added to plain finite elements, for pairs of contact points near each other.

    Attributes
    ----------
    starts : int64 (P + 1,), where the row of each point begins.
    others : int64 (z,), the second points of the pairs, ascending in each row.
    blocks : float64 (z, 3, 3), m / N at 1 Pa. The block of (j, i) is the transpose of (i, j)'s.
    """

    starts: NDArray[np.int64]
    others: NDArray[np.int64]
    blocks: NDArray[np.float64]

    def between(self, i: NDArray[np.int64], j: NDArray[np.int64]) -> NDArray[np.float64]:
        """The part for points ``i`` (k,) seen and ``j`` (l,) loaded, (k, l, 3, 3)."""
        found = np.zeros((len(i), len(j), 3, 3))
        for row, point in enumerate(i.tolist()):
            first, last = self.starts[point], self.starts[point + 1]
            place = np.searchsorted(self.others[first:last], j)
            inside = np.flatnonzero(place < last - first)
            inside = inside[self.others[first + place[inside]] == j[inside]]
            found[row, inside] = self.blocks[first + place[inside]]
        return found


def near_correction(body: SoftBody, points: ContactPoints, span: float) -> NearCorrection:
    """The correction for pairs of points within ``span`` metres, such as a tool's width: what is
    farther apart never touches it at once.
    """
    field = RegularField.of(body)
    i, j = _pairs(points, span)
    blocks = _corrections(field, points, i, j)
    own = i == j
    rows = np.concatenate([i, j[~own]])
    columns = np.concatenate([j, i[~own]])
    every = np.concatenate([blocks, blocks[~own].transpose(0, 2, 1)])
    order = np.lexsort((columns, rows))
    starts = np.searchsorted(rows[order], np.arange(len(points) + 1)).astype(np.int64)
    return NearCorrection(starts, columns[order], every[order])


def _pairs(points: ContactPoints, span: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs i <= j of points on one side of the body."""
    near = cKDTree(points.positions).query_pairs(span, output_type="ndarray")
    i, j = near.min(axis=1), near.max(axis=1)
    alike = facing(points.normals[i], points.normals[j], SAME_SURFACE) > 0
    own = np.arange(len(points))
    return np.concatenate([own, i[alike]]), np.concatenate([own, j[alike]])


def _corrections(
    field: RegularField, points: ContactPoints, i: NDArray[np.int64], j: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Blocks (k, 3, 3) for pairs of points."""
    triangles = field.body.mesh.surface_local_triangles[points.triangles]
    share = np.einsum("pc,pc->p", points.alphas, field.trusted[triangles])
    softness = np.einsum("pc,pc->p", points.alphas, field.softness[triangles])
    table, place = _table_of(field, points.triangles[i], points.triangles[j])
    blocks = np.empty((len(i), 3, 3))
    for first in range(0, len(i), PAIRS_TOGETHER):
        few = slice(first, first + PAIRS_TOGETHER)
        weights = points.alphas[i[few]][:, :, None] * points.alphas[j[few]][:, None, :]
        blocks[few] = -np.einsum("kab,kabxy->kxy", weights, table[place[few]], optimize=True)
    own = i == j
    blocks[own] += _own(field, points, softness)
    blocks[own] = 0.5 * (blocks[own] + blocks[own].transpose(0, 2, 1))
    a, b = i[~own], j[~own]
    blocks[~own] += half_space_between(field.body, points.positions, points.normals, softness, a, b)
    blocks[~own] *= facing(points.normals[a], points.normals[b], SAME_SURFACE)[:, None, None]
    blocks *= (share[i] * share[j])[:, None, None]
    blocks[own] += _lifted(field, points, softness, blocks[own], 1 - share**2)
    return blocks


def _own(
    field: RegularField, points: ContactPoints, softness: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The half-space's part of how each point gives way to its own force, (P, 3, 3)."""
    nu = field.body.poisson_ratio
    alone = softness * _sharpness(field.body, points)
    moved = alone[:, None, None] * own_displacement(points.areas, points.normals, nu)
    across = np.eye(3) - np.einsum("px,py->pxy", points.normals, points.normals)
    lifted: NDArray[np.float64] = moved + ACROSS[field.body.formulation] * across @ moved @ across
    return lifted


def _lifted(
    field: RegularField,
    points: ContactPoints,
    softness: NDArray[np.float64],
    own: NDArray[np.float64],
    pinned: NDArray[np.float64],
) -> NDArray[np.float64]:
    """What is to be added to ``own`` (P, 3, 3) so that no point is held by more than all of it."""
    body, count = field.body, len(points)
    corners = body.mesh.surface_local_triangles[points.triangles]
    seen, loaded = np.repeat(corners, 3, axis=1), np.tile(corners, (1, 3))
    resolved = pair_blocks(body, seen.reshape(-1), loaded.reshape(-1)).reshape(count, 3, 3, 3, 3)
    weights = np.einsum("pa,pb->pab", points.alphas, points.alphas)
    whole = own + np.einsum("pab,pabxy->pxy", weights, resolved)
    firmest = OWN_PINNED / np.linalg.eigvalsh(body.contact_blocks).max()
    whole += firmest * pinned[:, None, None] * np.eye(3)
    alone = own_displacement(points.areas, points.normals, body.poisson_ratio)
    least = LEAST_OWN * softness * np.linalg.eigvalsh(alone)[:, 0] * (1 - pinned)
    missing = np.maximum(least - np.linalg.eigvalsh(whole)[:, 0], 0.0)
    lift: NDArray[np.float64] = (firmest * pinned + missing)[:, None, None] * np.eye(3)
    return lift


def _sharpness(body: SoftBody, points: ContactPoints) -> NDArray[np.float64]:
    """How much more than a half-space a point gives way on an edge or a tip, (P,), 1 and more.

    The power of what there is around it to hold it that a cube's edge and tip come out as finite
    elements have them, 2.5 and 6. A surface that is only made of flat triangles is not sharp.
    """
    around = solid_angles(body.mesh, points.triangles, points.alphas) / FLAT
    low, high = ROUND
    sharp = np.clip((high - around) / (high - low), 0.0, 1.0)
    sharpness: NDArray[np.float64] = 1.0 + sharp * np.maximum(around**-SHARPENING - 1.0, 0.0)
    return sharpness


def _table_of(
    field: RegularField, first: NDArray[np.int64], second: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A table of blocks (q, 3, 3), and where those between the corners of triangles ``first`` (k,)
    and ``second`` (k,) stand in it, (k, 3, 3).
    """
    triangles, nodes = field.body.mesh.surface_local_triangles, len(field.normals)
    # Far fewer than the pairs of points: these first, then the nodes of each of these.
    codes, pair = np.unique(first * len(triangles) + second, return_inverse=True)
    here, there = (triangles[side] for side in np.divmod(codes, len(triangles)))
    both, place = np.unique(here[:, :, None] * nodes + there[:, None, :], return_inverse=True)
    return _node_table(field, *np.divmod(both, nodes)), place.reshape(-1, 3, 3)[pair.reshape(-1)]


def _node_table(
    field: RegularField, a: NDArray[np.int64], b: NDArray[np.int64]
) -> NDArray[np.float64]:
    """What stands in L for the half-space, for pairs of nodes, (k, 3, 3)."""
    places = field.places
    apart = np.linalg.norm(places[a] - places[b], axis=1) / (
        0.5 * (field.edges[a] + field.edges[b])
    )
    never, wholly, _, _ = BELIEVED[field.body.formulation]
    doubt = np.clip((wholly - apart) / (wholly - never), 0.0, 1.0)
    blocks = np.zeros((len(a), 3, 3))
    far = np.flatnonzero(doubt < 1)
    blocks[far] = (1 - doubt[far])[:, None, None] * half_space_between(
        field.body, places, field.normals, field.softness, a[far], b[far]
    )
    near = np.flatnonzero(doubt > 0)
    resolved = pair_blocks(field.body, a[near], b[near])
    regular = field.between(a[near], b[near])
    blocks[near] += doubt[near][:, None, None] * (resolved - regular)
    return blocks


def point_compliance(
    body: SoftBody,
    points: ContactPoints,
    i: NDArray[np.int64],
    j: NDArray[np.int64],
    correction: NearCorrection | None = None,
) -> NDArray[np.float64]:
    """Displacement of points ``i`` (k,) per force on ``j`` (l,), at unit modulus: (k, l, 3, 3).

    Without a correction, C(x, y) = sum_ab alpha_a(x) alpha_b(y) L_ab.
    """
    rows, weigh_rows = _weights(body, points, i)
    columns, weigh_columns = _weights(body, points, j)
    blocks = body.surface_blocks(rows, columns)
    left = (weigh_rows @ blocks.reshape(len(rows), -1)).reshape(len(i), len(columns), 9)
    turned = left.transpose(1, 0, 2).reshape(len(columns), -1)
    both = (weigh_columns @ turned).reshape(len(j), len(i), 3, 3)
    compliance: NDArray[np.float64] = both.transpose(1, 0, 2, 3)
    return compliance if correction is None else compliance + correction.between(i, j)


def _weights(
    body: SoftBody, points: ContactPoints, chosen: NDArray[np.int64]
) -> tuple[NDArray[np.int64], csr_array]:
    """The surface-local nodes (m,) that carry the chosen points (k,), and their weights (k, m)."""
    corners = body.mesh.surface_local_triangles[points.triangles[chosen]]
    nodes, place = np.unique(corners, return_inverse=True)
    rows = np.repeat(np.arange(len(chosen)), 3)
    weights = csr_array(
        (points.alphas[chosen].ravel(), (rows, place.reshape(-1))), shape=(len(chosen), len(nodes))
    )
    return nodes, weights
