"""Tools from any convex mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from ...errors import PalpateError
from ...mesh.coordinates import refuse_unusable
from ...sentence import Sentence
from .tools import MOST_CORE_POINTS, SHARPEST_ROUNDING, Tool, span


def convex(vertices: ArrayLike, rounding: float = 0.0, name: str = "convex mesh") -> Tool:
    """Convex hull of ``vertices`` (v, 3), metres, about their own origin, its edges rounded.

    Edges are rounded within the hull, by ``rounding`` or at least a tenth of the inner radius. More
    corners than a tool may have are simplified to those that stand out in well-spread directions.

    Raises
    ------
    PalpateError
        Fewer than four vertices or all in one plane, numbers that are not finite, a rounding that
        is negative or too large for the hull.
    """
    given = np.asarray(vertices, dtype=np.float64)
    if given.ndim != 2 or given.shape[1] != 3 or len(given) < 4:
        raise PalpateError(
            "tool {name}: vertices have shape {shape}, expected (v, 3) with v >= 4; choose a mesh "
            "with volume",
            name=name,
            shape=given.shape,
        )
    refuse_unusable(Sentence("tool {name}", name=name), given)
    if span(given)[0] < 3:
        raise PalpateError(
            "tool {name}: its {count} vertices lie in one plane, so it has no inside; give it "
            "some thickness, or choose the plate",
            name=name,
            count=len(given),
        )
    if not rounding >= 0.0:
        raise PalpateError(
            "tool {name}: rounding is {rounding}; give zero or more metres",
            name=name,
            rounding=rounding,
        )
    outer = given[ConvexHull(given).vertices]
    planes = ConvexHull(outer).equations
    middle = outer.mean(axis=0)
    room = -float((planes[:, :3] @ middle + planes[:, 3]).max())
    edge = max(rounding, SHARPEST_ROUNDING * room)
    if edge >= 0.9 * room:
        raise PalpateError(
            "tool {name}: a rounding of {edge:g} m leaves nothing of a hull of which {room:g} m "
            "lie about its middle; give less than {most:g} m",
            name=name,
            edge=edge,
            room=room,
            most=0.9 * room,
        )
    within = planes + np.array([0.0, 0.0, 0.0, edge])
    try:
        inset = HalfspaceIntersection(within, middle).intersections
    except QhullError as error:
        raise PalpateError(
            "tool {name}: its hull cannot be rounded ({reason}); simplify the mesh",
            name=name,
            reason=str(error).splitlines()[0],
        ) from error
    corners = inset[ConvexHull(inset).vertices]
    return Tool(name, _outstanding(corners, MOST_CORE_POINTS), edge)


def _outstanding(corners: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """At most ``most`` of ``corners`` (v, 3): the farthest in directions spread over a sphere."""
    if len(corners) <= most:
        return corners
    # Directions along a spiral of equal areas (Fibonacci lattice).
    step = np.arange(most) + 0.5
    z = 1.0 - 2.0 * step / most
    turn = np.pi * (1.0 + np.sqrt(5.0)) * step
    level = np.sqrt(1.0 - z * z)
    directions = np.column_stack([level * np.cos(turn), level * np.sin(turn), z])
    chosen = np.unique(((corners - corners.mean(axis=0)) @ directions.T).argmax(axis=0))
    few: NDArray[np.float64] = corners[chosen]
    return few
