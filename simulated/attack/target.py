"""What is touched while it is attacked: a small cube, or a body that was baked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core.body.body_file import load
from ...core.servo.session import Body, native_body

EDGE = 0.05
YOUNG_MODULUS = 10_000.0
ABOVE = (0.026, 0.024, 0.06)
DEEP = (0.026, 0.024, 0.042)
HOVER_METRES = 0.005
DEPTH_SHARE = 0.02
FORCE = 0.8
"""On a finger in the depth of a baked body, N."""
SQUARES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


@dataclass(frozen=True)
class Target:
    """Body and the places of a finger above, close above and in it, along an axis, m."""

    name: str
    body: Body
    young_modulus: float
    above: NDArray[np.float64]
    hover: NDArray[np.float64]
    deep: NDArray[np.float64]
    inward: NDArray[np.float64]
    """Unit vector."""

    def elsewhere(self, offset: NDArray[np.float64]) -> Target:
        """Return the same with all places moved."""
        return replace(
            self, above=self.above + offset, hover=self.hover + offset, deep=self.deep + offset
        )


def cube(edge: float = EDGE) -> Body:
    """Eight corners of 100 N/m at 10 kPa each."""
    nodes = [[x, y, z] for x in (0.0, edge) for y in (0.0, edge) for z in (0.0, edge)]
    triangles = [half for a, b, c, d in SQUARES for half in ((a, b, c), (a, c, d))]
    return Body(np.array(nodes), np.array(triangles), np.tile(np.eye(3) * 0.01, (8, 1, 1)))


def cube_target() -> Target:
    """The cube, from above."""
    above, deep = np.array(ABOVE), np.array(DEEP)
    hover = np.array([above[0], above[1], EDGE + HOVER_METRES])
    return Target("cube", cube(), YOUNG_MODULUS, above, hover, deep, np.array([0.0, 0.0, -1.0]))


def baked_target(path: Path) -> Target:
    """Target on a baked body, touched at the middle of its highest triangle.

    Its modulus is such that the force there is that of the cube. Raises PalpateError for no body.
    """
    body = load(path)
    native = native_body(body)
    nodes = body.mesh.nodes[body.mesh.surface_nodes]
    size = float(np.linalg.norm(np.ptp(nodes, axis=0)))
    middles = nodes[body.mesh.surface_local_triangles].mean(axis=1)
    triangle, alpha, place, _ = native.closest_point(middles[np.argmax(middles[:, 2])])
    inward = np.array([0.0, 0.0, -1.0])
    depth = DEPTH_SHARE * size
    _, felt = native.contact(triangle, alpha, depth * inward, 1.0)
    return Target(
        name=path.stem,
        body=native,
        young_modulus=FORCE / float(np.linalg.norm(felt)),
        above=place - 2.0 * HOVER_METRES * inward,
        hover=place - HOVER_METRES * inward,
        deep=place + depth * inward,
        inward=inward,
    )
