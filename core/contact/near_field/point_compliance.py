"""Compliance between contact points: the mesh's elements, with the near field or without."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ...body.soft_body import SoftBody
from .compliance_beneath import NearCorrection
from .contact_points import ContactPoints


def point_compliance(
    body: SoftBody,
    points: ContactPoints,
    i: NDArray[np.int64],
    j: NDArray[np.int64],
    correction: NearCorrection | None = None,
) -> NDArray[np.float64]:
    """Displacement of points ``i`` (k,) per force on ``j`` (l,), at unit modulus: (k, l, 3, 3).

    Without a correction, C(x, y) = sum_ab alpha_a(x) alpha_b(y) L_ab.
    """
    rows, weigh_rows = _weights(body, points, i)
    columns, weigh_columns = _weights(body, points, j)
    blocks = body.surface_blocks(rows, columns)
    left = (weigh_rows @ blocks.reshape(len(rows), -1)).reshape(len(i), len(columns), 9)
    turned = left.transpose(1, 0, 2).reshape(len(columns), -1)
    both = (weigh_columns @ turned).reshape(len(j), len(i), 3, 3)
    compliance: NDArray[np.float64] = both.transpose(1, 0, 2, 3)
    return compliance if correction is None else compliance + correction.between(i, j)


def _weights(
    body: SoftBody, points: ContactPoints, chosen: NDArray[np.int64]
) -> tuple[NDArray[np.int64], csr_array]:
    """Surface-local nodes (m,) of the chosen points (k,), and their weights (k, m)."""
    corners = body.mesh.surface_local_triangles[points.triangles[chosen]]
    nodes, place = np.unique(corners, return_inverse=True)
    rows = np.repeat(np.arange(len(chosen)), 3)
    weights = csr_array(
        (points.alphas[chosen].ravel(), (rows, place.reshape(-1))), shape=(len(chosen), len(nodes))
    )
    return nodes, weights
