"""What a force at one place of a surface moves another place by, below the fineness of the mesh.

Finite elements cannot resolve what is smaller than they are: how far a node gives way under its own
force depends on the mesh (about as one over its edges), and between nodes all is as smooth as the
elements. But close to a force every smooth surface gives way as a half-space does, H, and what the
body adds to that is smooth. So

    C(x, y) = H(x - y) + sum_ab alpha_a(x) alpha_b(y) (L_ab - H_ab)

where L_ab - H_ab is taken as it is for nodes far enough apart, and for a node itself and its
neighbours from around them, where finite elements are accurate. The part of a force's own cell in H
is that of :mod:`.half_space`. See docs/near-field.md for evidence and limits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from .contact_points import ContactPoints, node_normals
from .formulation import LINEAR, SMOOTHED
from .half_space import own_displacement, surface_displacement
from .pair_blocks import pair_blocks
from .soft_body import SoftBody
from .solid_angle import FLAT, solid_angles

# Distances in mean edge lengths of the two nodes: within the first finite elements are not believed
# at all, from the second on wholly; what they miss is taken from the ring between the third
# and the fourth. Smoothed elements spread a force over more of their neighbours.
BELIEVED = {LINEAR: (0.6, 1.0, 0.9, 2.2), SMOOTHED: (1.2, 2.0, 1.6, 2.8)}

# Places whose normals have a smaller product than the first are not of one surface, from the second
# on they are wholly: for the ring, which is to know one side of an edge from the other, and for H,
# which may reach around an edge but not through a thin part.
SAME_SIDE = (0.2, 0.7)
SAME_SURFACE = (-0.5, 0.0)

# A pinned point gives way by this share of what the body's firmest node does under its own force,
# besides what its nodes do: between three pinned nodes no point is the sum of others.
OWN_PINNED = 0.1

# A point with more than the second of these shares of a half-space around it is on a round surface,
# with less than the first on an edge.
ROUND = (0.55, 0.75)

SHARPENING = 1.3

# By how much more a point gives way to its own force along the surface than in a half-space. What
# smoothed elements have between neighbours swings, and would else leave blocks of several points
# not positive definite (by at most 0.2 where meshes are coarse and bodies thin).
ACROSS = {LINEAR: 0.0, SMOOTHED: 0.35}

# How firmly slopes are held at zero, in mean squares of edge lengths.
SLOPE_DAMPING = 0.1

# A ring of fewer neighbours than this says nothing.
FEWEST_IN_RING = 2.0

# Pairs of triangles worked on together; bounds memory to some 100 MB.
PAIRS_TOGETHER = 50_000


@dataclass(frozen=True, eq=False)
class NearField:
    """What the correction between contact points needs to know of a body.

    Attributes
    ----------
    normals : float64 (s, 3), outward unit normals at the surface nodes.
    edges : float64 (s,), mean length of the surface's edges at each node, metres.
    regular : float64 (s, 3, 3), how far a node gives way beyond a half-space, m / N at 1 Pa.
    slope : float64 (s, 3, 3, 3), how that changes per metre as the force moves away, by direction.
    softness : float64 (s,), 1 over the factor of Young's modulus around the node.
    trusted : float64 (s,), 0 where nothing is known and plain finite elements stay, else 1.
    """

    body: SoftBody
    normals: NDArray[np.float64]
    edges: NDArray[np.float64]
    regular: NDArray[np.float64]
    slope: NDArray[np.float64]
    softness: NDArray[np.float64]
    trusted: NDArray[np.float64]

    @classmethod
    def of(cls, body: SoftBody) -> NearField:
        """Look at the rings around all surface nodes."""
        mesh = body.mesh
        normals, edges, softness = node_normals(mesh), mean_edges(body), surface_softness(body)
        places = mesh.nodes[mesh.surface_nodes]
        _, _, inner, outer = BELIEVED[body.formulation]
        a, b = _within(places, outer * edges)
        apart = np.linalg.norm(places[a] - places[b], axis=1)
        reach = 0.5 * (edges[a] + edges[b])
        facing = _facing(normals[a], normals[b], SAME_SIDE)
        ring = np.flatnonzero((apart >= inner * reach) & (apart <= outer * reach) & (facing > 0))
        a, b, weight = a[ring], b[ring], facing[ring]
        beyond = pair_blocks(body, a, b) - _between_nodes(body, places, normals, softness, a, b)
        # Seen at a with the force at b, and the other way round.
        regular, slope, known = _fitted(
            np.concatenate([a, b]),
            np.concatenate([places[b] - places[a], places[a] - places[b]]),
            np.concatenate([beyond, beyond.transpose(0, 2, 1)]),
            np.concatenate([weight, weight]),
            edges,
        )
        free = body.free_index(mesh.surface_nodes) >= 0
        return cls(
            body, normals, edges, regular, slope, softness, (known & free).astype(np.float64)
        )


def _fitted(
    node: NDArray[np.int64],
    offsets: NDArray[np.float64],
    beyond: NDArray[np.float64],
    weight: NDArray[np.float64],
    edges: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Value (s, 3, 3) and slope (s, 3, 3, 3) at each node of what its ring tells, and where known.

    Least squares over the samples ``beyond`` (k, 3, 3) of ``node`` (k,) at ``offsets`` (k, 3).
    """
    count = len(edges)
    terms = np.column_stack([np.ones(len(node)), offsets / edges[node, None]])
    ring = csr_array((weight, (node, np.arange(len(node)))), shape=(count, len(node)))
    both = np.einsum("ki,kj->kij", terms, terms).reshape(-1, 16)
    sides = np.einsum("ki,kx->kix", terms, beyond.reshape(-1, 9)).reshape(-1, 36)
    normal, right = (ring @ both).reshape(-1, 4, 4), (ring @ sides).reshape(-1, 4, 9)
    total = normal[:, 0, 0]
    known = total >= FEWEST_IN_RING
    # Across the surface, and where all of a ring lies to one side, a slope is not to be had.
    damping = SLOPE_DAMPING * np.maximum(total, 1.0)[:, None, None] * np.diag([0.0, 1.0, 1.0, 1.0])
    fit = np.zeros((count, 4, 9))
    fit[known] = np.linalg.solve(normal[known] + damping[known], right[known])
    regular = fit[:, 0].reshape(-1, 3, 3)
    slope = (fit[:, 1:] / edges[:, None, None]).reshape(-1, 3, 3, 3)
    return 0.5 * (regular + regular.transpose(0, 2, 1)), slope, known


def _within(
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


def _facing(
    first: NDArray[np.float64], second: NDArray[np.float64], limits: tuple[float, float]
) -> NDArray[np.float64]:
    """How far two normals (k, 3) are of one side or surface, (k,), 0 to 1."""
    alike = np.einsum("kx,kx->k", first, second)
    share: NDArray[np.float64] = np.clip((alike - limits[0]) / (limits[1] - limits[0]), 0.0, 1.0)
    return share


def _between_nodes(
    body: SoftBody,
    places: NDArray[np.float64],
    normals: NDArray[np.float64],
    softness: NDArray[np.float64],
    a: NDArray[np.int64],
    b: NDArray[np.int64],
) -> NDArray[np.float64]:
    """H between places a (k,) and b (k,), (k, 3, 3)."""
    normal = normals[a] + normals[b]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 0.5)
    blocks = surface_displacement(places[a] - places[b], normal, body.poisson_ratio)
    blocks *= (0.5 * (softness[a] + softness[b]))[:, None, None]
    return blocks


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
    field = NearField.of(body)
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
    alike = _facing(points.normals[i], points.normals[j], SAME_SURFACE) > 0
    own = np.arange(len(points))
    return np.concatenate([own, i[alike]]), np.concatenate([own, j[alike]])


def _corrections(
    field: NearField, points: ContactPoints, i: NDArray[np.int64], j: NDArray[np.int64]
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
    nu = field.body.poisson_ratio
    alone = softness * _sharpness(field.body, points)
    alone_moved = alone[:, None, None] * own_displacement(points.areas, points.normals, nu)
    across = np.eye(3) - np.einsum("px,py->pxy", points.normals, points.normals)
    lift = ACROSS[field.body.formulation]
    blocks[own] += alone_moved + lift * across @ alone_moved @ across
    a, b = i[~own], j[~own]
    facing = _facing(points.normals[a], points.normals[b], SAME_SURFACE)[:, None, None]
    blocks[~own] += _between_nodes(field.body, points.positions, points.normals, softness, a, b)
    blocks[~own] *= facing
    blocks[own] = 0.5 * (blocks[own] + blocks[own].transpose(0, 2, 1))
    blocks *= (share[i] * share[j])[:, None, None]
    pinned = OWN_PINNED / np.linalg.eigvalsh(field.body.contact_blocks).max()
    blocks[own] += pinned * (1 - share**2)[:, None, None] * np.eye(3)
    return blocks


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
    field: NearField, first: NDArray[np.int64], second: NDArray[np.int64]
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


def _regular_between(
    field: NearField,
    places: NDArray[np.float64],
    a: NDArray[np.int64],
    b: NDArray[np.int64],
) -> NDArray[np.float64]:
    """What the rings tell of nodes that are near each other, (k, 3, 3): mean of both views."""
    offset = places[b] - places[a]
    from_a = field.regular[a] + np.einsum("kz,kzxy->kxy", offset, field.slope[a])
    from_b = field.regular[b] - np.einsum("kz,kzxy->kxy", offset, field.slope[b])
    mean: NDArray[np.float64] = 0.5 * (from_a + from_b.transpose(0, 2, 1))
    return mean


def _node_table(
    field: NearField, a: NDArray[np.int64], b: NDArray[np.int64]
) -> NDArray[np.float64]:
    """What stands in L for the half-space, for pairs of nodes, (k, 3, 3)."""
    mesh = field.body.mesh
    places = mesh.nodes[mesh.surface_nodes]
    apart = np.linalg.norm(places[a] - places[b], axis=1) / (
        0.5 * (field.edges[a] + field.edges[b])
    )
    never, wholly, _, _ = BELIEVED[field.body.formulation]
    doubt = np.clip((wholly - apart) / (wholly - never), 0.0, 1.0)
    blocks = np.zeros((len(a), 3, 3))
    far = np.flatnonzero(doubt < 1)
    blocks[far] = (1 - doubt[far])[:, None, None] * _between_nodes(
        field.body, places, field.normals, field.softness, a[far], b[far]
    )
    near = np.flatnonzero(doubt > 0)
    resolved = pair_blocks(field.body, a[near], b[near])
    regular = _regular_between(field, places, a[near], b[near])
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
