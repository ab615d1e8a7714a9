"""Compliance between places of a surface, below the resolution of the mesh.

A node's displacement under its own force depends on the mesh (about as one over its edges), and
between nodes it is as smooth as the elements. But close to a force every smooth surface behaves as
a half-space, H, and the rest is smooth. So

    C(x, y) = H(x - y) + sum_ab alpha_a(x) alpha_b(y) (L_ab - H_ab)

where L_ab - H_ab is taken as it is for nodes far enough apart, and for a node itself and its next
neighbours from :mod:`.regular_field`. The part of a force's own cell in H is that of
:mod:`.half_space`. See docs/near-field.md for evidence and limits.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...body.pair_blocks import pair_blocks
from ...body.soft_body import SoftBody
from ...stiffness.formulation import LINEAR, SMOOTHED
from .contact_points import ContactPoints
from .half_space import half_space_between, least_own_displacement, own_displacement
from .regular_field import (
    BELIEVED,
    SHORT_NOWHERE,
    SHORT_WITHIN,
    RegularField,
    facing,
)
from .rim_field import with_rims
from .solid_angle import sharpness, solid_angles
from .surface_nodes import of_one_material

# Points whose normals have a smaller product than the first are not of one surface, from the second
# on they are wholly: H may reach around an edge, but not through a thin part.
SAME_SURFACE = (-0.5, 0.0)

# A pinned point gives way by this share of what the body's firmest node does under its own force,
# besides what its nodes do: between three pinned nodes no point is the sum of others.
OWN_PINNED = 0.1

# No point gives way to its own force by less than this share of what it does in a half-space: what
# is left where pins are nearer than the points are apart.
LEAST_OWN = 0.25

# How far a point gives way to its own force, as a share of what is right under a smooth pressure
# (OWN_CELL). At the border of a contact the pressure ends like a root, somewhere between points,
# and a few points carry less than the pressure that they stand for: by Hertz, on a half-space, 1.5
# and 0.6 % with points 0.8 and 0.55 of the contact's radius apart (a sphere's own at 0.05 and 0.1
# of its radius deep), and as much again where they lie unevenly, as on bodies. This makes up for
# it in the mean; evenly placed, 0.4 % too much at most, less the larger the contact.
IN_CONTACT = 0.974

# By how much more a point gives way to its own force along the surface than in a half-space. What
# smoothed elements have between neighbours swings, and would else leave blocks of several points
# not positive definite (by up to a third where meshes are coarse and bodies thin).
ACROSS = {LINEAR: 0.0, SMOOTHED: 0.35}

# Pairs of triangles worked on together; bounds memory to some 100 MB.
PAIRS_TOGETHER = 50_000


@dataclass(frozen=True, eq=False)
class NearCorrection:
    """Correction of finite elements between contact points of a body.

    Pairs are not stored: a tool touches a few dozen points, bodies have millions of pairs.

    Attributes
    ----------
    field : at the surface's nodes.
    points : the P contact points.
    shares : float64 (P,), 0 where plain finite elements stay, else up to 1.
    softness : float64 (P,), 1 over the factor of Young's modulus around each point.
    own : float64 (P, 3, 3), for each point and its own force, m / N at 1 Pa, symmetric.
    lifts : float64 (P, 3, m), m ways of the points; a force along one moves all along it, by their
        products, in root of m / N at 1 Pa. None but on free bodies (``core/rest/definite.py``).
    """

    field: RegularField
    points: ContactPoints
    shares: NDArray[np.float64]
    softness: NDArray[np.float64]
    own: NDArray[np.float64]
    lifts: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.empty((0, 3, 0)))
    _last: _Known = dataclasses.field(default_factory=lambda: _Known(), repr=False)  # noqa: PLW0108  defined below

    def between(self, i: NDArray[np.int64], j: NDArray[np.int64]) -> NDArray[np.float64]:
        """Correction for points ``i`` (k,) seen and ``j`` (l,) loaded, (k, l, 3, 3).

        The block of (j, i) is the transpose of (i, j)'s. Of all pairs of the same points the last
        are kept: along a path most are those of the step before.
        """
        if not np.array_equal(i, j):
            return self._pairs(np.repeat(i, len(j)), np.tile(j, len(i))).reshape(
                len(i), len(j), 3, 3
            )
        known, blocks = self._last.points, np.empty((len(i), len(i), 3, 3))
        place = np.searchsorted(known, i)
        place[place == len(known)] = 0
        old = known[place] == i if len(known) else np.zeros(len(i), dtype=np.bool_)
        kept, new = np.flatnonzero(old), np.flatnonzero(~old)
        blocks[kept[:, None], kept] = self._last.blocks[place[kept][:, None], place[kept]]
        rows = self._pairs(np.repeat(i[new], len(i)), np.tile(i, len(new)))
        rows = rows.reshape(len(new), len(i), 3, 3)
        blocks[new], blocks[:, new] = rows, rows.transpose(1, 0, 3, 2)
        if np.all(np.diff(i) > 0):
            self._last.points, self._last.blocks = i.copy(), blocks
        return blocks.copy()

    def lifted(self, lifts: NDArray[np.float64]) -> NearCorrection:
        """The same with other ``lifts`` (P, 3, m)."""
        return NearCorrection(self.field, self.points, self.shares, self.softness, self.own, lifts)

    def arrays(self) -> dict[str, object]:
        """Arrays for the native thread, which computes the pairs itself."""
        field = self.field
        never, wholly, _, outer = BELIEVED[field.body.formulation]
        return {
            "normals": field.normals,
            "edges": field.edges,
            "softness": field.softness,
            "excess": field.excess,
            "regular": field.regular,
            "slopes": field.slope.reshape(-1, 3, 3),
            "far_nodes": field.far.nodes,
            "far_weights": field.far.weights,
            "shares": self.shares,
            "softness_of_points": self.softness,
            "own": self.own,
            "lifts": self.lifts.transpose(0, 2, 1).reshape(-1, 3),
            "believed": (never, wholly),
            "short": (SHORT_WITHIN * outer, SHORT_NOWHERE * outer),
            "poisson_ratio": field.body.poisson_ratio,
        }

    def _pairs(self, i: NDArray[np.int64], j: NDArray[np.int64]) -> NDArray[np.float64]:
        """Blocks (k, 3, 3) for pairs of points ``i`` (k,) and ``j`` (k,)."""
        blocks = np.empty((len(i), 3, 3))
        own = i == j
        blocks[own] = self.own[i[own]]
        apart = np.flatnonzero(~own)
        first, second = np.minimum(i[apart], j[apart]), np.maximum(i[apart], j[apart])
        found = _corrections(self, first, second)
        turned = i[apart] > j[apart]
        found[turned] = found[turned].transpose(0, 2, 1)
        blocks[apart] = found
        if self.lifts.size:
            blocks += np.einsum("kxm,kym->kxy", self.lifts[i], self.lifts[j])
        return blocks


@dataclass(eq=False)
class _Known:
    """Latest blocks (k, k, 3, 3) between ``points`` (k,), ascending."""

    points: NDArray[np.int64] = dataclasses.field(default_factory=lambda: np.empty(0, np.int64))
    blocks: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.empty((0, 0, 3, 3)))


def near_correction(
    body: SoftBody, points: ContactPoints, field: RegularField | None = None
) -> NearCorrection:
    """Correction for the contact points of a body, computed for pairs on demand. The body's
    ``field`` is computed unless given.
    """
    field = with_rims(RegularField.of(body)) if field is None else field
    triangles = body.mesh.surface_local_triangles[points.triangles]
    shares = np.einsum("pc,pc->p", points.alphas, field.trusted[triangles])
    softness = np.einsum("pc,pc->p", points.alphas, field.softness[triangles])
    everyone = np.arange(len(points))
    own = _own(field, points, softness) + _replaced(field, points, everyone, everyone)
    own = 0.5 * (own + own.transpose(0, 2, 1)) * (shares**2)[:, None, None]
    own += _lifted(field, points, softness, own, 1 - shares**2)
    return NearCorrection(field, points, shares, softness, own)


def _corrections(
    near: NearCorrection, i: NDArray[np.int64], j: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Blocks (k, 3, 3) for pairs of points, none with itself."""
    points, field = near.points, near.field
    share = near.shares[i] * near.shares[j]
    share *= facing(points.normals[i], points.normals[j], SAME_SURFACE)
    share *= of_one_material(near.softness[i], near.softness[j])
    counts = np.flatnonzero(share > 0.0)
    blocks = np.zeros((len(i), 3, 3))
    for first in range(0, len(counts), PAIRS_TOGETHER):
        few = counts[first : first + PAIRS_TOGETHER]
        a, b = i[few], j[few]
        found = _replaced(field, points, a, b)
        found += half_space_between(
            field.body.poisson_ratio, points.positions, points.normals, near.softness, a, b
        )
        blocks[few] = share[few][:, None, None] * found
    return blocks


def _replaced(
    field: RegularField, points: ContactPoints, i: NDArray[np.int64], j: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Finite elements' part in place of the half-space, negative, (k, 3, 3)."""
    table, place = _table_of(field, points.triangles[i], points.triangles[j])
    weights = points.alphas[i][:, :, None] * points.alphas[j][:, None, :]
    taken = np.zeros((len(i), 9))
    flat = table.reshape(-1, 9)
    for a in range(3):
        for b in range(3):
            taken -= weights[:, a, b, None] * flat[place[:, a, b]]
    return taken.reshape(-1, 3, 3)


def _own(
    field: RegularField, points: ContactPoints, softness: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Half-space part of each point's own compliance, (P, 3, 3)."""
    nu = field.body.poisson_ratio
    sharp = sharpness(solid_angles(field.body.mesh, points.triangles, points.alphas))
    alone = IN_CONTACT * softness * sharp
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
    """Addition to ``own`` (P, 3, 3) that keeps every point's own compliance above its minimum."""
    body, count = field.body, len(points)
    # Far fewer triangles than points lie on them.
    used, place = np.unique(points.triangles, return_inverse=True)
    corners = body.mesh.surface_local_triangles[used]
    seen, loaded = np.repeat(corners, 3, axis=1), np.tile(corners, (1, 3))
    resolved = pair_blocks(body, seen.reshape(-1), loaded.reshape(-1)).reshape(len(used), 9, 9)
    weights = (points.alphas[:, :, None] * points.alphas[:, None, :]).reshape(count, 9)
    whole = own.copy()
    for pair in range(9):
        whole += (weights[:, pair, None] * resolved[place, pair]).reshape(count, 3, 3)
    firmest = OWN_PINNED / np.linalg.eigvalsh(body.contact_blocks).max()
    whole += firmest * pinned[:, None, None] * np.eye(3)
    alone = least_own_displacement(points.areas, points.normals, body.poisson_ratio)
    least = LEAST_OWN * softness * alone * (1 - pinned)
    missing = np.maximum(least - np.linalg.eigvalsh(whole)[:, 0], 0.0)
    lift: NDArray[np.float64] = (firmest * pinned + missing)[:, None, None] * np.eye(3)
    return lift


def _table_of(
    field: RegularField, first: NDArray[np.int64], second: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Table of blocks (q, 3, 3), and the places in it of those between the corners of triangles
    ``first`` (k,) and ``second`` (k,), (k, 3, 3).
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
    """Half-space part of L, for pairs of nodes, (k, 3, 3)."""
    places = field.places
    apart = np.linalg.norm(places[a] - places[b], axis=1) / (
        0.5 * (field.edges[a] + field.edges[b])
    )
    never, wholly, _, _ = BELIEVED[field.body.formulation]
    doubt = np.clip((wholly - apart) / (wholly - never), 0.0, 1.0)
    blocks = np.zeros((len(a), 3, 3))
    far = np.flatnonzero(doubt < 1)
    resembled = field.short(a[far], b[far]) + half_space_between(
        field.body.poisson_ratio, places, field.normals, field.softness, a[far], b[far]
    )
    blocks[far] = (1 - doubt[far])[:, None, None] * resembled
    near = np.flatnonzero(doubt > 0)
    resolved = pair_blocks(field.body, a[near], b[near])
    regular = field.between(a[near], b[near])
    blocks[near] += doubt[near][:, None, None] * (resolved - regular)
    return blocks
