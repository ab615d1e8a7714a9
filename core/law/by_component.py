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
