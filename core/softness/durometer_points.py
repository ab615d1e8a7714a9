"""Contact points of a durometer: rings under its indenter and its foot.

They lie on the surface, independent of its nodes, so that a reading does not depend on the mesh
under an indenter of two millimetres.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..body.soft_body import SoftBody
from ..contact.near_field.contact_points import ContactPoints
from ..contact.near_field.surface_shape import smooth_corner_normals
from ..contact.place import Place, nearest_place
from .parallel_rays import Crossings, across, crossings, thickness
from .scales.durometer_type import DurometerType

# Rings of points around the middle one under the indenter, and across the foot's width.
TIP_RINGS = 6
FOOT_RINGS = 5


@dataclass(frozen=True, eq=False)
class Rings:
    """Rings of points in the plane of a durometer's foot.

    Attributes
    ----------
    places : float64 (p, 2), metres from the axis.
    areas : float64 (p,), share of indenter and foot, square metres.
    tip : bool (p,), whether a point is under the indenter, or else under the foot.
    """

    places: NDArray[np.float64]
    areas: NDArray[np.float64]
    tip: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Seat:
    """Position of a durometer on a body.

    Attributes
    ----------
    place : of its axis on the rest surface.
    points : the contact points.
    radii : float64 (p,), distances of the points from the axis, metres.
    heights : float64 (p,), depth of the rest surface below the place, metres.
    tip : bool (p,), whether a point is under the indenter.
    thickness : metres from the place to the far side of the body, along the axis.
    overhang : share of the foot that has no surface under it.
    """

    place: Place
    points: ContactPoints
    radii: NDArray[np.float64]
    heights: NDArray[np.float64]
    tip: NDArray[np.bool_]
    thickness: float
    overhang: float


def rings(kind: DurometerType) -> Rings:
    """Evenly spread points: a central one and rings of 6, 12, ... under the indenter, and rings
    as close to each other as their points under the foot.
    """
    step = kind.shaft / (TIP_RINGS + 0.5)
    wide = (kind.foot - kind.hole) / FOOT_RINGS
    made = [_ring(0.0, 1, np.pi / 4 * step**2, 0)]
    made += [_ring(k * step, 6 * k, np.pi / 3 * step**2, 0) for k in range(1, TIP_RINGS + 1)]
    tip_count = sum(len(places) for places, _ in made)
    for k in range(FOOT_RINGS):
        radius = kind.hole + (k + 0.5) * wide
        count = max(6, round(2 * np.pi * radius / wide))
        made.append(_ring(radius, count, 2 * np.pi * radius * wide / count, k % 2))
    places = np.concatenate([places for places, _ in made])
    areas = np.concatenate([areas for _, areas in made])
    return Rings(places, areas, np.arange(len(places)) < tip_count)


def _ring(
    radius: float, count: int, area: float, turned: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places (count, 2) on a circle and their areas (count,); ``turned`` by half a step or not, so
    that the points of neighbouring rings do not align.
    """
    angles = 2 * np.pi * (np.arange(count) + 0.5 * turned) / count
    places = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    return places, np.full(count, area)


def set_on(body: SoftBody, at: ArrayLike, kind: DurometerType) -> Seat:
    """Durometer at the surface point nearest to ``at`` (3,), metres, along the normal.

    Raises
    ------
    PalpateError
        Not three finite numbers.
    """
    place, ring = nearest_place(body, at), rings(kind)
    corner_normals = smooth_corner_normals(body.mesh)
    origins = place.position + ring.places @ across(place.axis)
    met = crossings(body.mesh, origins, place.axis)
    first = _first_entries(met, kind.foot)
    lines, triangles, alphas = met.lines[first], met.triangles[first], met.alphas[first]
    normals = np.einsum("pc,pcx->px", alphas, corner_normals[triangles])
    corners = body.mesh.nodes[body.mesh.surface_triangles[triangles]]
    points = ContactPoints(
        positions=np.einsum("pc,pcx->px", alphas, corners),
        normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        triangles=triangles,
        alphas=alphas,
        areas=ring.areas[lines],
    )
    tip = ring.tip[lines]
    foot = ring.areas[~ring.tip].sum()
    return Seat(
        place=place,
        points=points,
        radii=np.linalg.norm(ring.places[lines], axis=1),
        heights=met.heights[first],
        tip=tip,
        thickness=thickness(body, place),
        overhang=1.0 - float(points.areas[~tip].sum() / foot),
    )


def _first_entries(met: Crossings, reach: float) -> NDArray[np.int64]:
    """First crossing of each line into the body, within ``reach``."""
    chosen = np.flatnonzero(met.inward & (np.abs(met.heights) <= reach))
    _, first = np.unique(met.lines[chosen], return_index=True)
    return chosen[first]
