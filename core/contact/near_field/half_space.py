"""Surface displacement of an elastic half-space under a force on it, in closed form.

Boussinesq (1885) for the force along the normal, Cerruti (1882) for forces along the surface, both
in K. L. Johnson, *Contact Mechanics* (1985), sections 3.2 and 3.6. Young's modulus is 1 Pa.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# A pressure that varies smoothly, gathered in the points of a square lattice of cells of area A,
# moves one of these points by what all others do, plus its own force over this length: the rule
# of the punctured lattice needs 4 zeta(1/2) beta(1/2) = -3.9003 to be exact to second order (and
# 3.921 for a triangular one). A disc of even pressure has 3.54 in its middle and 3.01 on average.
OWN_CELL = 3.9003


def surface_displacement(
    offsets: NDArray[np.float64], normals: NDArray[np.float64], poisson_ratio: float
) -> NDArray[np.float64]:
    """Displacement per newton at ``offsets`` (k, 3) from the force, (k, 3, 3), metres at 1 Pa.

    ``normals`` (k, 3) are outward unit normals. Offsets may leave the tangent plane, as on a curved
    surface: the part without the coupling is Kelvin's tensor in other numbers, so it stays positive
    definite for places anywhere in space.

    u = (1 + nu) / (pi r) [(1 - nu) I + nu e e^T + (1 - 2 nu) / 2 (e n^T - n e^T)], e = offset / r.
    """
    distance = np.linalg.norm(offsets, axis=1)
    along = offsets / distance[:, None]
    coupling = np.einsum("kx,ky->kxy", along, normals)
    blocks = poisson_ratio * np.einsum("kx,ky->kxy", along, along)
    blocks += (1 - poisson_ratio) * np.eye(3)
    blocks += (0.5 - poisson_ratio) * (coupling - coupling.transpose(0, 2, 1))
    scale = (1 + poisson_ratio) / (np.pi * distance)
    scaled: NDArray[np.float64] = scale[:, None, None] * blocks
    return scaled


def own_displacement(
    areas: NDArray[np.float64], normals: NDArray[np.float64], poisson_ratio: float
) -> NDArray[np.float64]:
    """Displacement per newton of a point by the force of its own cell, (k, 3, 3), metres at 1 Pa.

    ``areas`` (k,) of the cells, square metres. All directions within the surface being alike, the
    mean of e e^T is half the identity there, and the coupling with the normal cancels.
    """
    across = np.eye(3) - np.einsum("kx,ky->kxy", normals, normals)
    blocks = (1 - poisson_ratio) * np.eye(3) + 0.5 * poisson_ratio * across
    scale = (1 + poisson_ratio) / np.pi * OWN_CELL / np.sqrt(areas)
    scaled: NDArray[np.float64] = scale[:, None, None] * blocks
    return scaled


def least_own_displacement(
    areas: NDArray[np.float64], normals: NDArray[np.float64], poisson_ratio: float
) -> NDArray[np.floating]:
    """The same in the direction in which it is least, (k,)."""
    return np.linalg.eigvalsh(own_displacement(areas, normals, poisson_ratio))[:, 0]


def half_space_between(
    poisson_ratio: float,
    places: NDArray[np.float64],
    normals: NDArray[np.float64],
    softness: NDArray[np.float64],
    a: NDArray[np.int64],
    b: NDArray[np.int64],
) -> NDArray[np.float64]:
    """H between places a (k,) and b (k,), (k, 3, 3), by their ``softness``."""
    normal = unit_normals(normals[a] + normals[b])
    blocks = surface_displacement(places[a] - places[b], normal, poisson_ratio)
    blocks *= np.sqrt(softness[a] * softness[b])[:, None, None]
    return blocks


def unit_normals(sums: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sums of two normals (k, 3) made unit vectors; shorter ones where they cancel."""
    unit: NDArray[np.float64] = sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 0.5)
    return unit
