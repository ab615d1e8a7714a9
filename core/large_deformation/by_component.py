"""Vectors and 3 x 3 matrices of many places at once, each component one contiguous row.

Vectors are (3, d), matrices (3, 3, d): numpy then works along the places, several times faster than
on as many small matrices.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def identity_added(matrices: Array) -> Array:
    """I + A."""
    added = matrices.copy()
    for axis in range(3):
        added[axis, axis] += 1.0
    return added


def product(a: Array, b: Array) -> Array:
    """A B."""
    found: Array = np.einsum("ijd,jkd->ikd", a, b)
    return found


def transposed_product(a: Array, b: Array) -> Array:
    """A^T B."""
    found: Array = np.einsum("jid,jkd->ikd", a, b)
    return found


def symmetric_part(matrices: Array) -> Array:
    """(A + A^T) / 2."""
    symmetric: Array = 0.5 * (matrices + matrices.swapaxes(0, 1))
    return symmetric


def axial(matrices: Array) -> Array:
    """The vector w of A - A^T = [w]x, twice the rotation where A is a small displacement's."""
    a = matrices
    return np.stack([a[2, 1] - a[1, 2], a[0, 2] - a[2, 0], a[1, 0] - a[0, 1]])


def cross_matrices(vectors: Array) -> Array:
    """[w]x, so that [w]x a = w x a."""
    x, y, z = vectors
    nothing = np.zeros_like(x)
    return np.stack([[nothing, -z, y], [z, nothing, -x], [-y, x, nothing]])


def cross(a: Array, b: Array) -> Array:
    """The vector product a x b."""
    return np.stack(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def determinants(matrices: Array) -> Array:
    """Det A, (d,)."""
    found: Array = np.einsum("id,id->d", matrices[0], cross(matrices[1], matrices[2]))
    return found


def inverse_above_identity(matrices: Array) -> Array:
    """A^-1 of symmetric A whose eigenvalues are 1 or more.

    So the determinant is at least 1 and no entry of the inverse is larger, which rounding would not
    keep where the eigenvalues differ by many orders of magnitude.
    """
    rows = np.stack(
        [
            cross(matrices[1], matrices[2]),
            cross(matrices[2], matrices[0]),
            cross(matrices[0], matrices[1]),
        ]
    )
    rows /= np.maximum(np.einsum("id,id->d", matrices[0], rows[0]), 1.0)
    return np.clip(rows, -1.0, 1.0, out=rows)
