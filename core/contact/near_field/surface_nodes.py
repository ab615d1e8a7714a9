"""Edge lengths and softness at the surface nodes of a body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody

# Moduli that differ by the first factor are of one material, by the second of two.
ONE_MATERIAL = (4.0, 40.0)


def mean_edges(body: SoftBody) -> NDArray[np.float64]:
    """Mean length of the surface edges at each surface node, (s,), metres."""
    mesh = body.mesh
    triangles, places = mesh.surface_local_triangles, mesh.nodes[mesh.surface_nodes]
    ahead = np.roll(triangles, -1, axis=1)
    lengths = np.linalg.norm(places[triangles] - places[ahead], axis=2).ravel()
    # Every edge of a closed surface is met twice, once from either side.
    count = np.bincount(triangles.ravel(), minlength=len(places))
    mean: NDArray[np.float64] = np.bincount(triangles.ravel(), lengths, len(places)) / count
    return mean


def surface_softness(body: SoftBody) -> NDArray[np.float64]:
    """1 over the factor of Young's modulus at each surface node, (s,): mean of its tetrahedra."""
    mesh = body.mesh
    if body.young_scale is None:
        return np.ones(len(mesh.surface_nodes))
    weight = np.repeat(mesh.tet_volumes, 4)
    stiff = np.bincount(mesh.tets.ravel(), weight * np.repeat(body.young_scale, 4))
    volume = np.bincount(mesh.tets.ravel(), weight)
    softness: NDArray[np.float64] = (volume / stiff)[mesh.surface_nodes]
    return softness


def of_one_material(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Degree to which two moduli or softnesses (k,) are of one material, (k,), 0 to 1.

    Across a bone's border in flesh a body is no half-space, of neither of the two.
    """
    alike, other = np.log(ONE_MATERIAL)
    share: NDArray[np.float64] = np.clip(
        (other - np.abs(np.log(first / second))) / (other - alike), 0.0, 1.0
    )
    return share


def surface_evenness(body: SoftBody) -> NDArray[np.float64]:
    """Degree to which all tetrahedra at each surface node are of one material, (s,), 0 to 1."""
    mesh = body.mesh
    if body.young_scale is None:
        return np.ones(len(mesh.surface_nodes))
    scale = np.repeat(body.young_scale, 4)
    least, most = np.full(len(mesh.nodes), np.inf), np.zeros(len(mesh.nodes))
    np.minimum.at(least, mesh.tets.ravel(), scale)
    np.maximum.at(most, mesh.tets.ravel(), scale)
    return of_one_material(most[mesh.surface_nodes], least[mesh.surface_nodes])
