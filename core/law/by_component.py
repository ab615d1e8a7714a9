"""Vectors and 3 x 3 matrices of many places at once, each component one contiguous row.

Vectors are (3, d), matrices (3, 3, d): numpy then works along the places, several times faster than
on as many small matrices.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# The axes after and before each, in turn.
NEXT, LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


def diagonal(matrices: Array) -> Array:
    """A view of the diagonal, (3, d)."""
    return matrices.reshape(9, -1)[::4]


def identity_added(matrices: Array) -> Array:
    """I + A."""
    added = matrices.copy()
    on_diagonal = diagonal(added)
    on_diagonal += 1.0
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
    found = np.empty((3, a.shape[2]))
    np.subtract(a[2, 1], a[1, 2], out=found[0])
    np.subtract(a[0, 2], a[2, 0], out=found[1])
    np.subtract(a[1, 0], a[0, 1], out=found[2])
    return found


def cross_matrices(vectors: Array) -> Array:
    """[w]x, so that [w]x a = w x a."""
    found = np.zeros((3, 3, vectors.shape[1]))
    found[2, 1], found[0, 2], found[1, 0] = vectors
    found[1, 2], found[2, 0], found[0, 1] = -vectors
    return found


def cross(a: Array, b: Array) -> Array:
    """The vector product a x b."""
    found: Array = a[NEXT] * b[LAST]
    found -= a[LAST] * b[NEXT]
    return found


def cofactors(matrices: Array) -> Array:
    """Cofactors of A, det A times its inverse transposed, (3, 3, d)."""
    following, last = matrices[NEXT], matrices[LAST]
    found: Array = following[:, NEXT] * last[:, LAST]
    found -= following[:, LAST] * last[:, NEXT]
    return found


def determinants(matrices: Array) -> Array:
    """Det A, (d,)."""
    found: Array = np.einsum("id,id->d", matrices[0], cross(matrices[1], matrices[2]))
    return found


def inverse_above_identity(matrices: Array) -> Array:
    """A^-1 of symmetric A whose eigenvalues are 1 or more.

    So the determinant is at least 1 and no entry of the inverse is larger, which rounding would not
    keep where the eigenvalues differ by many orders of magnitude.
    """
    rows = cofactors(matrices)
    rows /= np.maximum(np.einsum("id,id->d", matrices[0], rows[0]), 1.0)
    return np.clip(rows, -1.0, 1.0, out=rows)
