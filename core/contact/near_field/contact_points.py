"""Contact points: fixed places on a body's surface where a rigid tool may touch it.

A tool meets the body in these points only. They are fixed on the body, so the force is the gradient
of an elastic energy and does not jump. They are spread evenly, on a coarse mesh also between its
nodes, on a fine one on some of its nodes, so that the force does not depend on the mesh.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...body.soft_body import SoftBody
from ...errors import PalpateError
from ...mesh.tet_mesh import TetMesh
from .surface_shape import (
    edge_lengths,
    face_areas,
    node_normals,
    on_curved_triangles,
    smooth_corner_normals,
    surface_area,
    unit,
)
from .surface_shares import surface_shares

# Shares of the spacing. Nodes that all triangles meet in are thinned out to the first; points of
# the lattices, which are 0.6 to 1.4 apart where triangles are not slender, to the second.
CLOSEST_NODES = 0.75
CLOSEST_OTHERS = 0.55


# How many points there are on the square of the spacing.
POINTS_PER_SPACING_SQUARED = 1.3

# Points that a body may carry: what belongs to them takes half a kilobyte each, and a second for
# every 50,000.
MOST_ON_BODY = 100_000

# How much wider than a tool asks for points may lie where they would be too many.
WIDEST = 2.5

# Points are no farther apart than this share of the root of the whole surface, however large the
# tool: some 500 on any body.
LARGEST_SHARE = 0.05


@dataclass(frozen=True, eq=False)
class ContactPoints:
    """Contact points on the rest surface, P of them.

    Attributes
    ----------
    positions : float64 (P, 3), metres.
    normals : float64 (P, 3), outward unit normals of the surface.
    triangles : int64 (P,), number of the surface triangle that a point lies in.
    alphas : float64 (P, 3), its area coordinates there, sum 1.
    areas : float64 (P,), its share of the surface, square metres; all together the whole surface.
    """

    positions: NDArray[np.float64]
    normals: NDArray[np.float64]
    triangles: NDArray[np.int64]
    alphas: NDArray[np.float64]
    areas: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.positions)

    def followed_by(self, others: ContactPoints) -> ContactPoints:
        """These points and ``others`` behind them."""
        return ContactPoints(
            np.concatenate([self.positions, others.positions]),
            np.concatenate([self.normals, others.normals]),
            np.concatenate([self.triangles, others.triangles]),
            np.concatenate([self.alphas, others.alphas]),
            np.concatenate([self.areas, others.areas]),
        )

    def taken(self, chosen: NDArray[np.int64] | NDArray[np.bool_]) -> ContactPoints:
        """The ``chosen`` points, by number or mask (P,), with their areas."""
        return ContactPoints(
            self.positions[chosen],
            self.normals[chosen],
            self.triangles[chosen],
            self.alphas[chosen],
            self.areas[chosen],
        )


def contact_points(
    body: SoftBody, spacing: float | NDArray[np.float64], *, rounded: bool = False
) -> ContactPoints:
    """Points on the surface about ``spacing`` metres apart, everywhere or one for each surface node
    (s,); the least of a triangle's corners counts. ``rounded``, they lie on the curved surface that
    the flat triangles stand for.

    Triangles with longer edges carry a regular lattice, edges as many points as their own length
    asks for, whatever triangle they are seen from. Where nodes lie closer than the spacing, a
    well-spread part of them is left.

    Raises
    ------
    PalpateError
        A spacing that is not positive and finite, or asks for more points than
        :data:`MOST_ON_BODY`.
    """
    mesh = body.mesh
    at_nodes = np.broadcast_to(np.asarray(spacing, np.float64), mesh.surface_nodes.shape)
    least = float(at_nodes.min())
    if not (np.isfinite(at_nodes).all() and least > 0):
        raise PalpateError(
            "contact points: a spacing of {spacing} m leaves nothing to choose; give a positive "
            "length, for a fingertip about a third of its radius",
            spacing=least,
        )
    spacings: NDArray[np.float64] = at_nodes[mesh.surface_local_triangles].min(axis=1)
    expected = int(POINTS_PER_SPACING_SQUARED * float((face_areas(mesh) / spacings**2).sum()))
    if expected > MOST_ON_BODY:
        raise PalpateError(
            "contact points: {millimetres:.3g} mm apart the body would have about {expected} of "
            "them, more than {most}; take a larger tool",
            millimetres=1000 * least,
            expected=expected,
            most=MOST_ON_BODY,
        )
    corner_normals = smooth_corner_normals(mesh)
    everything = _join(_nodes(mesh), _on_edges(mesh, at_nodes), _inside(mesh, spacings))
    normals = _normals(mesh, corner_normals, everything)
    corners = mesh.nodes[mesh.surface_triangles[everything.triangles]]
    positions = np.einsum("pc,pcx->px", everything.alphas, corners)
    kept = _spread(positions, normals, everything.is_node, spacings[everything.triangles])
    areas = surface_shares(mesh, corner_normals, positions[kept], normals[kept], spacings)
    # A point none of the surface is nearest to is no place of its own.
    kept, areas = kept[areas > 0], areas[areas > 0]
    if rounded:
        turned = corner_normals[everything.triangles]
        positions = on_curved_triangles(corners, turned, everything.alphas)
    return ContactPoints(
        positions[kept],
        normals[kept],
        everything.triangles[kept],
        everything.alphas[kept],
        areas,
    )


def spacing_on(body: SoftBody, spacing: float) -> float:
    """Spacing within the bounds of the body, metres.

    No closer than :data:`MOST_ON_BODY` points lie: so a tool may be small for its body, down to
    where it would fall between the points. No wider than :data:`LARGEST_SHARE` says: so it may be
    much larger than its body.
    """
    root = float(np.sqrt(surface_area(body.mesh)))
    allowed = root * float(np.sqrt(POINTS_PER_SPACING_SQUARED / MOST_ON_BODY))
    asked = min(spacing, LARGEST_SHARE * root)
    return min(max(asked, 1.01 * allowed), WIDEST * asked)


@dataclass(frozen=True, eq=False)
class _Places:
    """Places of points: ``triangles`` (p,), ``alphas`` (p, 3), ``others`` (p,) the triangle on the
    far side of an edge (elsewhere the same), ``is_node`` (p,).
    """

    triangles: NDArray[np.int64]
    alphas: NDArray[np.float64]
    others: NDArray[np.int64]
    is_node: NDArray[np.bool_]


def _join(*parts: _Places) -> _Places:
    return _Places(
        np.concatenate([part.triangles for part in parts]),
        np.concatenate([part.alphas for part in parts]),
        np.concatenate([part.others for part in parts]),
        np.concatenate([part.is_node for part in parts]),
    )


def _nodes(mesh: TetMesh) -> _Places:
    """Every surface node, in one of its triangles."""
    _, first = np.unique(mesh.surface_local_triangles, return_index=True)
    triangle, corner = np.divmod(first, 3)
    return _Places(triangle, np.eye(3)[corner], triangle, np.ones(len(first), dtype=np.bool_))


def _on_edges(mesh: TetMesh, at_nodes: NDArray[np.float64]) -> _Places:
    """Points that divide each edge into equal parts, by the least spacing of its ends; without
    these.
    """
    triangles = mesh.surface_local_triangles
    # Edge number 3 t + c runs from corner c of triangle t to the next one.
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    _, first, edge = np.unique(
        np.sort(ends, axis=1), axis=0, return_index=True, return_inverse=True
    )
    edge = edge.reshape(-1)
    far_side = np.zeros(len(first), dtype=np.int64)
    far_side[edge] = np.arange(len(ends)) // 3
    later = np.arange(len(ends)) != first[edge]
    far_side[edge[later]] = np.flatnonzero(later) // 3
    spacing = at_nodes[ends[first]].min(axis=1)
    parts = _parts(edge_lengths(mesh).reshape(-1)[first], spacing)
    which = np.repeat(np.arange(len(first)), parts - 1)
    step = 1 + np.arange(len(which)) - np.repeat(np.cumsum(parts - 1) - (parts - 1), parts - 1)
    share = step / parts[which]
    triangle, corner = np.divmod(first[which], 3)
    rows = np.arange(len(which))
    alphas = np.zeros((len(which), 3))
    alphas[rows, corner] = 1.0 - share
    alphas[rows, (corner + 1) % 3] = share
    return _Places(triangle, alphas, far_side[which], np.zeros(len(which), dtype=np.bool_))


def _inside(mesh: TetMesh, spacings: NDArray[np.float64]) -> _Places:
    """A regular lattice within each triangle, of its spacing, without its edges."""
    mean_square = (edge_lengths(mesh) ** 2).mean(axis=1)
    parts = _parts(np.sqrt(mean_square), spacings)
    triangles, alphas = [np.empty(0, dtype=np.int64)], [np.empty((0, 3))]
    for count in np.unique(parts[parts > 2]).tolist():
        lattice = _inner_lattice(count)
        members = np.flatnonzero(parts == count)
        triangles.append(np.repeat(members, len(lattice)))
        alphas.append(np.tile(lattice, (len(members), 1)))
    triangle = np.concatenate(triangles)
    return _Places(
        triangle, np.concatenate(alphas), triangle, np.zeros(len(triangle), dtype=np.bool_)
    )


def _inner_lattice(parts: int) -> NDArray[np.float64]:
    """Area coordinates (l, 3) of the lattice points strictly inside a triangle."""
    i, j = np.indices((parts, parts))
    inner = (i > 0) & (j > 0) & (i + j < parts)
    return np.column_stack([parts - i[inner] - j[inner], i[inner], j[inner]]) / parts


def _parts(lengths: NDArray[np.float64], spacing: NDArray[np.float64]) -> NDArray[np.int64]:
    """Number of parts of a length that come nearest to the spacing, as a ratio."""
    exact = 0.5 * (np.sqrt(1.0 + 4.0 * (lengths / spacing) ** 2) - 1.0)
    return np.maximum(np.ceil(exact - 1e-9), 1).astype(np.int64)


def _spread(
    positions: NDArray[np.float64],
    normals: NDArray[np.float64],
    is_node: NDArray[np.bool_],
    spacing: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Points to keep so that none on the same side of the body are too close, ascending.

    Each point in turn is kept unless one before it is close: nodes first.
    """
    reach = np.where(is_node, CLOSEST_NODES, CLOSEST_OTHERS) * spacing
    widest = CLOSEST_NODES * float(spacing.max())
    pairs = cKDTree(positions).query_pairs(widest, output_type="ndarray")
    first, second = pairs.min(axis=1), pairs.max(axis=1)
    apart = np.linalg.norm(positions[first] - positions[second], axis=1)
    facing = np.einsum("px,px->p", normals[first], normals[second]) > 0
    close = facing & (apart < reach[second] * (1 - 1e-9))
    first, second = first[close], second[close]
    order = np.argsort(second, kind="stable")
    first, second = first[order], second[order]
    starts = np.searchsorted(second, np.arange(len(positions) + 1))
    kept = np.ones(len(positions), dtype=np.bool_)
    for point in np.unique(second).tolist():
        kept[point] = not kept[first[starts[point] : starts[point + 1]]].any()
    return np.flatnonzero(kept)


def _normals(
    mesh: TetMesh, corner_normals: NDArray[np.float64], places: _Places
) -> NDArray[np.float64]:
    """Unit normals (p, 3): across a crease, and at the tip where several meet, their mean."""
    here = np.einsum("pc,pcx->px", places.alphas, corner_normals[places.triangles])
    on_edge = places.others != places.triangles
    others = places.others[on_edge]
    shared = mesh.surface_triangles[places.triangles[on_edge]]
    # The same place seen from the far side: its corners that are the same nodes weigh the same.
    same = mesh.surface_triangles[others][:, :, None] == shared[:, None, :]
    there = np.einsum("pcd,pd->pc", same, places.alphas[on_edge])
    here[on_edge] += np.einsum("pc,pcx->px", there, corner_normals[others])
    at_node = np.flatnonzero(places.is_node)
    here[at_node] = node_normals(mesh)
    return unit(here)
