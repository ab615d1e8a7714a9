"""Regular field near sharp edges, for elements that are right in the mean.

Smoothed tetrahedra give way too far to a force on one node, and its neighbours too little: under an
even pressure that cancels, all the way to the rim of a face. The ring that a regular field is told
from does not see it: at a rim a body differs from a half-space by a share of the half-space itself,
which grows towards the force. Told from the ring a rim was too firm, and a plate over a whole face
by a tenth to a half.

So there the field is the one with which an even pressure on all that the elements are not believed
in moves a node as far as the elements say.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from ...body.pair_blocks import pair_blocks
from ...stiffness.formulation import SMOOTHED
from .half_space import half_space_between, own_displacement
from .regular_field import (
    BELIEVED,
    SAME_SIDE,
    RegularField,
    facing,
    seen_across,
)
from .solid_angle import edge_shares, node_angles, sharpness
from .surface_nodes import of_one_material, pairs_within
from .surface_shape import node_areas


def with_rims(field: RegularField) -> RegularField:
    """The field with the nodes near sharp edges held in the mean, if its elements are smoothed."""
    body = field.body
    if body.formulation != SMOOTHED:
        return field
    a, b, weight = _doubted(field)
    # Each pair from both its ends.
    node, other = np.concatenate([a, b]), np.concatenate([b, a])
    weight = np.concatenate([weight, weight])
    angles = node_angles(body.mesh)
    sharp = edge_shares(angles)
    share = sharp * field.trusted
    np.maximum.at(share, node, weight * sharp[other] * field.trusted[node])
    softness = field.softness * sharpness(angles)
    missing = _in_the_mean(field, softness, node, other, weight) - field.regular
    # Along the normal and across it: how a push draws aside an even pressure does not tell.
    along = np.einsum("sx,sy->sxy", field.normals, field.normals)
    across = np.eye(3) - along
    missing = along @ missing @ along + across @ missing @ across
    regular = field.regular + share[:, None, None] * missing
    return dataclasses.replace(field, regular=regular)


def _doubted(
    field: RegularField,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Pairs of nodes between which elements are not believed, and by which share, (k,) each."""
    places = field.places
    never, wholly, _, _ = BELIEVED[field.body.formulation]
    a, b = pairs_within(places, wholly * field.edges)
    reach = 0.5 * (field.edges[a] + field.edges[b])
    apart = np.linalg.norm(places[a] - places[b], axis=1) / reach
    weight = np.clip((wholly - apart) / (wholly - never), 0.0, 1.0)
    weight *= of_one_material(field.softness[a], field.softness[b])
    return a, b, weight * facing(field.normals[a], field.normals[b], SAME_SIDE)


def _in_the_mean(
    field: RegularField,
    softness: NDArray[np.float64],
    node: NDArray[np.int64],
    other: NDArray[np.int64],
    weight: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Regular part (s, 3, 3) by an even pressure on each ``node`` and its ``other`` nodes (k,);
    nodes give way by themselves ``softness`` (s,) times as far as a half-space.
    """
    body, places = field.body, field.places
    areas, everyone = node_areas(body.mesh), np.arange(len(places))
    own = own_displacement(areas, field.normals, body.poisson_ratio)
    own *= softness[:, None, None]
    summed = pair_blocks(body, everyone, everyone) - own
    summed -= seen_across(body, field.far, everyone, everyone)
    summed *= areas[:, None, None]
    beyond = pair_blocks(body, node, other)
    beyond -= half_space_between(
        body.poisson_ratio, places, field.normals, field.softness, node, other
    )
    beyond -= np.einsum("kz,kzxy->kxy", places[other] - places[node], field.slope[node])
    beyond -= seen_across(body, field.far, node, other)
    pressed = weight * areas[other]
    np.add.at(summed, node, pressed[:, None, None] * beyond)
    total = areas + np.bincount(node, pressed, len(places))
    mean: NDArray[np.float64] = summed / total[:, None, None]
    return 0.5 * (mean + mean.transpose(0, 2, 1))
