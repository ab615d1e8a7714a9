"""Stiffer and softer regions of a body, as factors on Young's modulus."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from ..mesh.closest_point import ClosestPoints
from ..mesh.surface import Surface
from ..mesh.tet_mesh import LARGEST_SCALE, TetMesh, young_scale_checked
from .surface_parts import nested_parts


@dataclass(frozen=True, eq=False)
class StiffRegion:
    """Region painted on the input surface's vertices.

    Attributes
    ----------
    weights : float64 (V,), 0 to 1.
    factor : on Young's modulus where the weight is 1; where it is w the factor is ``factor**w``,
        so that equal steps of weight feel like equal steps of stiffness.
    """

    weights: NDArray[np.float64]
    factor: float


@dataclass(frozen=True, eq=False)
class TetScale:
    """Factors on Young's modulus, float64 (M,), for a body given as tetrahedra."""

    values: NDArray[np.float64]


def young_scale(
    stiffness: StiffRegion | TetScale, mesh: TetMesh, surface: Surface | None
) -> NDArray[np.float64]:
    """Factor on Young's modulus for each tetrahedron, (M,).

    Inside an inner part of the surface (a bone in flesh) the weight is that of the nearest place
    on this part; everywhere else of the nearest place on the outer surface.

    Parameters
    ----------
    stiffness : painted on a surface, or one factor for each tetrahedron.
    mesh : the body.
    surface : the painted one; None for a body given as tetrahedra.

    Raises
    ------
    PalpateError
        Factors out of range, weights without a surface or not one per vertex between 0 and 1.
    """
    if isinstance(stiffness, TetScale):
        return young_scale_checked(stiffness.values, len(mesh.tets))
    weights, painted = _checked(stiffness, surface)
    weight = _carried_inside(weights, painted, mesh.nodes[mesh.tets].mean(axis=1))
    return young_scale_checked(stiffness.factor**weight, len(mesh.tets))


def _carried_inside(
    weights: NDArray[np.float64], surface: Surface, points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Weights (p,) at ``points`` (p, 3) inside the body."""
    parts = nested_parts(surface)
    weight = _nearest(weights, surface, parts.outer, points)
    left = np.arange(len(points))
    for part in parts.inner:
        enclosed = part.encloses(points[left])
        inside = left[enclosed]
        weight[inside] = _nearest(weights, surface, part.triangles, points[inside])
        left = left[~enclosed]
    return weight


def _nearest(
    weights: NDArray[np.float64],
    surface: Surface,
    triangles: NDArray[np.int64],
    points: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Weight of the place nearest to each point on some ``triangles`` of the surface."""
    places = ClosestPoints(surface.vertices, triangles).query(points)
    corners = weights[triangles[places.triangle]]
    weight: NDArray[np.float64] = np.einsum("pc,pc->p", places.alpha, corners)
    return np.clip(weight, 0.0, 1.0)


def _checked(region: StiffRegion, surface: Surface | None) -> tuple[NDArray[np.float64], Surface]:
    if not 1 / LARGEST_SCALE <= region.factor <= LARGEST_SCALE:
        raise PalpateError(
            "stiff region: the factor is {factor}, but must lie between {least:g} and {most:g}; 1 "
            "changes nothing, and 1000 makes bone in flesh",
            factor=region.factor,
            least=1 / LARGEST_SCALE,
            most=LARGEST_SCALE,
        )
    weights = np.asarray(region.weights, dtype=np.float64)
    if surface is None or weights.shape != (len(surface.vertices),):
        raise PalpateError(
            "stiff region: painted weights need the surface they were painted on, one weight per "
            "vertex; for tetrahedra give one factor each (young_scale)"
        )
    if not ((weights >= 0) & (weights <= 1)).all():
        raise PalpateError("stiff region: a weight is not between 0 and 1; paint the group again")
    return weights, surface
