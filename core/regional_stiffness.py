"""Places of a body that are stiffer or softer than the rest, as factors on Young's modulus."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .closest_point import ClosestPoints
from .errors import PalpateError
from .stiffness import LARGEST_SCALE, young_scale_checked
from .surface import Surface
from .tet_mesh import TetMesh


@dataclass(frozen=True, eq=False)
class StiffRegion:
    """A region painted on the input surface's vertices.

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
    """Factors on Young's modulus, float64 (M,), for a body that is given as tetrahedra."""

    values: NDArray[np.float64]


def young_scale(
    region: StiffRegion | TetScale, mesh: TetMesh, surface: Surface | None
) -> NDArray[np.float64]:
    """Factor on Young's modulus for each tetrahedron, (M,).

    ``surface`` is the one the weights of a :class:`StiffRegion` were painted on, None for a body
    given as tetrahedra.

    Raises
    ------
    PalpateError
        Factors out of range, weights without a surface or not one per vertex between 0 and 1.
    """
    if isinstance(region, TetScale):
        return young_scale_checked(region.values, len(mesh.tets))
    weights, painted = _checked(region, surface)
    centres = mesh.nodes[mesh.tets].mean(axis=1)
    places = ClosestPoints(painted.vertices, painted.triangles).query(centres)
    weight = np.einsum("pc,pc->p", places.alpha, weights[painted.triangles[places.triangle]])
    return young_scale_checked(region.factor**weight, len(mesh.tets))


def _checked(region: StiffRegion, surface: Surface | None) -> tuple[NDArray[np.float64], Surface]:
    if not 1 / LARGEST_SCALE <= region.factor <= LARGEST_SCALE:
        raise PalpateError(
            f"stiff region: the factor is {region.factor}, but must lie between "
            f"{1 / LARGEST_SCALE:g} and {LARGEST_SCALE:g}; bone in flesh is about 1000 or more"
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
