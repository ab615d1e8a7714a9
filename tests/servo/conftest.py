"""Bodies for the servo's tests; nothing of core is needed."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pytest
from palpate_servo import Body

if TYPE_CHECKING:
    from numpy.typing import NDArray

YOUNG_MODULUS = 10_000.0


@dataclass(frozen=True)
class SoftCube:
    """The paper's cube, 50 mm, 98 surface nodes, with made-up stiffness, native and as arrays."""

    nodes: NDArray[np.float64]
    triangles: NDArray[np.int64]
    blocks: NDArray[np.float64]
    native: Body


def _cube_surface(cells: int, edge: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    numbers: dict[tuple[int, ...], int] = {}
    triangles = []
    for axis, far in itertools.product(range(3), (False, True)):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for i, j in itertools.product(range(cells), repeat=2):
            square = []
            for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = [0, 0, 0]
                corner[axis] = cells if far else 0
                corner[u], corner[v] = i + di, j + dj
                square.append(numbers.setdefault(tuple(corner), len(numbers)))
            a, b, c, d = square if far else square[::-1]
            halves = ([a, b, c], [a, c, d]) if (i + j) % 2 else ([a, b, d], [b, c, d])
            triangles.extend(halves)
    return np.array(list(numbers), float) * (edge / cells), np.array(triangles)


@pytest.fixture(scope="session")
def cube() -> SoftCube:
    nodes, triangles = _cube_surface(4, 0.05)
    assert (len(nodes), len(triangles)) == (98, 192)
    factors = np.random.default_rng(98).normal(size=(len(nodes), 3, 3))
    # About 100 N/m at 10 kPa, different from node to node and direction to direction.
    blocks = 0.004 * (factors @ factors.swapaxes(1, 2)) + 0.01 * np.eye(3)
    return SoftCube(nodes, triangles, blocks, Body(nodes, triangles, blocks))
