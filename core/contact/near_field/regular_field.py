"""Compliance of a body's surface beyond that of a half-space, at each node and around it.

Finite elements are not accurate for a node under its own force, nor for its next neighbours. But
the difference between the body and a half-space is smooth there: so it is told from a ring of nodes
around, where they are accurate, by a plane fitted to it.

One thing they are slow to get right: how far a push along the normal draws the surface around it
sideways, and a force aside lifts it. There they are short by about 1 / r^2, half of it at two
edges. So that share is told from the ring too, and taken for what it is, an error.

A thin part bends, on the scale of the ring: no plane. But how far the far side moves is nearly all
bending, and the elements have it right. So that is taken off the ring's samples, and added where
the fit is used: two forces that squeeze the part between them then meet no bending.

On a limp part, an ear or a tail, what is left of the bending is still a multiple of all that a
half-space gives way by, and of what the fit errs by. There plain finite elements stay.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ...body.pair_blocks import pair_blocks
from ...body.soft_body import SoftBody
from ...stiffness.formulation import LINEAR, SMOOTHED
from .far_side import FarSide, far_side
from .half_space import half_space_between, own_displacement, unit_normals
from .surface_nodes import (
    mean_edges,
    of_one_material,
    pairs_within,
    resolved_lengths,
    surface_evenness,
    surface_softness,
)
from .surface_shape import node_areas, node_normals

# Distances in mean edge lengths of two nodes: within the first finite elements are not believed at
# all, from the second on wholly; the ring lies between the third and the fourth. Smoothed elements
# spread a force over more of their neighbours.
BELIEVED = {LINEAR: (0.6, 1.0, 0.9, 2.2), SMOOTHED: (1.2, 2.0, 1.6, 2.8)}

# Nodes whose normals have a smaller product than the first are not of one side of an edge, from the
# second on they are wholly.
SAME_SIDE = (0.2, 0.7)

# Thickness in mean edge lengths up to which what the far side does is taken off before the fit, and
# from which on it is not.
THIN = (4.0, 6.0)

# How firmly slopes are held at zero, in mean squares of edge lengths.
SLOPE_DAMPING = 0.1

# Up to how many radii of the ring the elements are short of the coupling as within it.
SHORT_WITHIN, SHORT_NOWHERE = 1.0, 2.0

# Elements are short of the coupling by no more than this share of an edge's length (of twice what
# they usually are); what a ring tells beyond that, or of too much, is an edge's or a thin part's.
MOST_SHORT = 0.1

# Below this share of what it could be at most, the determinant of a ring tells nothing.
LEAST_SPREAD = 0.02

# Nodes that go along with their part up to so many times as far as they press into a half-space of
# the softest material are told by the ring, and from the second number on by the finite elements
# alone. Ears and tails have hundreds, stout bodies 3 at most.
LIMP = (3.0, 10.0)

# Neighbours of a ring at least.
FEWEST_IN_RING = 2.0


@dataclass(frozen=True, eq=False)
class RegularField:
    """Regular field of a body at its surface nodes.

    Attributes
    ----------
    body : of the field.
    normals : float64 (s, 3), outward unit normals at the surface nodes.
    edges : float64 (s,), length at each node in which distances to others are told, metres: that
        of the surface's edges or somewhat more, see :func:`.surface_nodes.resolved_lengths`.
    regular : float64 (s, 3, 3), how far a node gives way beyond a half-space, m / N at 1 Pa.
    slope : float64 (s, 3, 3, 3), how that changes per metre as the force moves away, by direction.
    excess : float64 (s,), what finite elements add to the coupling of pushes with displacements
        aside, times the distance squared, m^3 / N at 1 Pa; negative where they fall short.
    softness : float64 (s,), 1 over the factor of Young's modulus around the node.
    trusted : float64 (s,), 0 where nothing is known and plain finite elements stay, up to 1.
    far : what lies across the body, where it is thin. What a force moves there is no part of
        ``regular`` and ``slope``.
    """

    body: SoftBody
    normals: NDArray[np.float64]
    edges: NDArray[np.float64]
    regular: NDArray[np.float64]
    slope: NDArray[np.float64]
    excess: NDArray[np.float64]
    softness: NDArray[np.float64]
    trusted: NDArray[np.float64]
    far: FarSide

    @classmethod
    def of(cls, body: SoftBody) -> RegularField:
        """Regular field from the rings around all surface nodes."""
        mesh = body.mesh
        normals, softness = node_normals(mesh), surface_softness(body)
        edges, places = resolved_lengths(body, normals), mesh.nodes[mesh.surface_nodes]
        _, _, inner, outer = BELIEVED[body.formulation]
        a, b = pairs_within(places, outer * edges)
        apart = np.linalg.norm(places[a] - places[b], axis=1)
        reach = 0.5 * (edges[a] + edges[b])
        alike = facing(normals[a], normals[b], SAME_SIDE)
        alike *= of_one_material(softness[a], softness[b])
        ring = np.flatnonzero((apart >= inner * reach) & (apart <= outer * reach) & (alike > 0))
        a, b, weight = a[ring], b[ring], alike[ring]
        beyond = pair_blocks(body, a, b)
        beyond -= half_space_between(body.poisson_ratio, places, normals, softness, a, b)
        far = far_side(mesh, mean_edges(body), THIN)
        # Seen at a with the force at b, and the other way round.
        node, other = np.concatenate([a, b]), np.concatenate([b, a])
        offsets = places[other] - places[node]
        beyond = np.concatenate([beyond, beyond.transpose(0, 2, 1)])
        # The nodes themselves too: a compressed compliance is unpacked once for all of these.
        everyone = np.arange(len(places))
        across = seen_across(
            body, far, np.concatenate([node, everyone]), np.concatenate([other, everyone])
        )
        beyond -= across[: len(node)]
        weight = np.concatenate([weight, weight])
        coupling = _coupling(-offsets, normals[node] + normals[other])
        excess = _excess(node, offsets, beyond, coupling, weight, edges)
        excess = np.clip(excess, -MOST_SHORT * softness * edges, 0.0)
        distance = np.linalg.norm(offsets, axis=1)
        beyond -= (excess[node] / distance**2)[:, None, None] * coupling
        regular, slope, known = _fitted(node, offsets, beyond, weight, edges)
        trusted = surface_evenness(body)
        trusted[~known | (body.free_index(mesh.surface_nodes) < 0)] = 0.0
        trusted *= 1.0 - _limpness(body, normals, softness, regular + across[len(node) :])
        return cls(body, normals, edges, regular, slope, excess, softness, trusted, far)

    def between(self, a: NDArray[np.int64], b: NDArray[np.int64]) -> NDArray[np.float64]:
        """Regular part for nodes near each other, (k, 3, 3): the mean of both rings' estimates.

        Displacement of surface-local nodes ``a`` (k,) per force on ``b`` (k,).
        """
        offset = self.places[b] - self.places[a]
        from_a = self.regular[a] + np.einsum("kz,kzxy->kxy", offset, self.slope[a])
        from_b = self.regular[b] - np.einsum("kz,kzxy->kxy", offset, self.slope[b])
        from_a += seen_across(self.body, self.far, a, b)
        from_b += seen_across(self.body, self.far, b, a)
        mean: NDArray[np.float64] = 0.5 * (from_a + from_b.transpose(0, 2, 1))
        return mean

    def short(self, a: NDArray[np.int64], b: NDArray[np.int64]) -> NDArray[np.float64]:
        """Finite elements' error of the coupling between nodes that are not too near, (k, 3, 3).

        Displacement of surface-local nodes ``a`` (k,) per force on ``b`` (k,).
        """
        offset = self.places[a] - self.places[b]
        distance = np.linalg.norm(offset, axis=1)
        reach = 0.5 * (self.edges[a] + self.edges[b]) * BELIEVED[self.body.formulation][3]
        fading = (SHORT_NOWHERE - distance / reach) / (SHORT_NOWHERE - SHORT_WITHIN)
        size = 0.5 * (self.excess[a] + self.excess[b]) * np.clip(fading, 0.0, 1.0) / distance**2
        added: NDArray[np.float64] = size[:, None, None] * _coupling(
            offset, self.normals[a] + self.normals[b]
        )
        return added

    @property
    def places(self) -> NDArray[np.float64]:
        """Positions of the surface nodes, (s, 3), metres."""
        places: NDArray[np.float64] = self.body.mesh.nodes[self.body.mesh.surface_nodes]
        return places


def _limpness(
    body: SoftBody,
    normals: NDArray[np.float64],
    softness: NDArray[np.float64],
    along: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Degree to which each node is of a limp part, (s,), 0 to 1, by how far it goes ``along`` with
    its part under its own force, (s, 3, 3).
    """
    # A bone goes along with the flesh around it.
    alone = own_displacement(node_areas(body.mesh), normals, body.poisson_ratio) * softness.max()
    times = np.trace(along, axis1=1, axis2=2) / np.trace(alone, axis1=1, axis2=2)
    share: NDArray[np.float64] = np.interp(
        np.log(np.maximum(times, LIMP[0])), np.log(LIMP), (0.0, 1.0)
    )
    return share


def seen_across(
    body: SoftBody, far: FarSide, a: NDArray[np.int64], b: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Displacement of the places across from nodes ``a`` (k,) per force on nodes ``b`` (k,),
    (k, 3, 3); nothing where the body is thick.
    """
    moved = np.zeros((len(a), 3, 3))
    thin = np.flatnonzero(far.weights[a].any(axis=1))
    for corner in range(3):
        seen, weight = far.nodes[a[thin], corner], far.weights[a[thin], corner]
        moved[thin] += weight[:, None, None] * pair_blocks(body, seen, b[thin])
    return moved


def _coupling(offsets: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """Tensor of the normal-tangential coupling, e n^T - n e^T, (k, 3, 3).

    At ``offsets`` (k, 3) from the force, with ``normals`` (k, 3) of any length.
    """
    along = offsets / np.linalg.norm(offsets, axis=1, keepdims=True)
    normal = unit_normals(normals)
    product = np.einsum("kx,ky->kxy", along, normal)
    antisymmetric: NDArray[np.float64] = product - product.transpose(0, 2, 1)
    return antisymmetric


def _excess(
    node: NDArray[np.int64],
    offsets: NDArray[np.float64],
    beyond: NDArray[np.float64],
    coupling: NDArray[np.float64],
    weight: NDArray[np.float64],
    edges: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Finite elements' error of the coupling at each node, times the distance squared, (s,).

    Least squares over the samples of its ring (as in :func:`_fitted`) with two terms: one that
    grows with the distance, as a smooth field has it, and one that falls with its square.
    """
    apart = np.linalg.norm(offsets, axis=1) / edges[node]
    size = np.einsum("kxy,kxy->k", coupling, coupling)
    seen = 0.5 * np.einsum("kxy,kxy->k", beyond - beyond.transpose(0, 2, 1), coupling)
    smooth, error = apart, apart**-2
    sums = [
        np.bincount(node, weight * value, len(edges))
        for value in (
            size * smooth**2,
            size * smooth * error,
            size * error**2,
            seen * smooth,
            seen * error,
        )
    ]
    grows, mixed, falls, right_grows, right_falls = sums
    determinant = grows * falls - mixed**2
    # Where all neighbours are equally far the two cannot be told apart.
    clear = determinant > LEAST_SPREAD * grows * falls
    found = np.zeros(len(edges))
    found[clear] = (grows * right_falls - mixed * right_grows)[clear] / determinant[clear]
    return found * edges**2


def _fitted(
    node: NDArray[np.int64],
    offsets: NDArray[np.float64],
    beyond: NDArray[np.float64],
    weight: NDArray[np.float64],
    edges: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Value (s, 3, 3) and slope (s, 3, 3, 3) at each node from its ring, and where known.

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


def facing(
    first: NDArray[np.float64], second: NDArray[np.float64], limits: tuple[float, float]
) -> NDArray[np.float64]:
    """Degree to which two normals (k, 3) belong to one side or surface, (k,), 0 to 1."""
    alike = np.einsum("kx,kx->k", first, second)
    share: NDArray[np.float64] = np.clip((alike - limits[0]) / (limits[1] - limits[0]), 0.0, 1.0)
    return share
