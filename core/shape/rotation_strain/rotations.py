"""Rotations from rotation vectors, and how a rotation changes with its vector.

Vectors (3, d) and matrices (3, 3, d) by component; see :mod:`.by_component`. The exponential map
and its Jacobian: e.g. E. Eade, Lie Groups for 2D and 3D Transformations, 2017, section 3.
"""

from __future__ import annotations

import numpy as np

from ...law.by_component import Array, cross, cross_matrices, diagonal

# Below this angle squared the closed form of the third coefficient loses digits, and four terms of
# its series do not.
SERIES_BELOW = 0.05
# Angles below count as this one, where nothing differs any more.
SMALLEST_ANGLE = 1e-150


def rotations_less_identity(vectors: Array) -> Array:
    """R - I for rotations by the length of each vector about its direction, (3, 3, d)."""
    squared, sine, versine = _coefficients(vectors)
    scaled = versine * vectors
    turned: Array = np.einsum("id,jd->ijd", scaled, vectors)
    turned += cross_matrices(sine * vectors)
    on_diagonal = diagonal(turned)
    on_diagonal -= squared * versine
    return turned


def pulled_back_turns(vectors: Array, turns: Array) -> Array:
    """J^T a for ``turns`` a (3, d), where R^T dR = [J dw]x as the vector w changes by dw."""
    squared, sine, versine = _coefficients(vectors)
    small = squared < SERIES_BELOW
    s = np.where(small, squared, 0.0)
    series = (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0 * (1.0 - s / 110.0)))) / 6.0
    third = np.where(small, series, (1.0 - sine) / np.where(small, 1.0, squared))
    across = cross(vectors, turns)
    return turns + versine * across + third * cross(vectors, across)


def _coefficients(vectors: Array) -> tuple[Array, Array, Array]:
    """Angle squared, sin t / t and (1 - cos t) / t^2, each (d,)."""
    squared: Array = np.einsum("id,id->d", vectors, vectors)
    half = 0.5 * np.maximum(np.sqrt(squared), SMALLEST_ANGLE)
    chord = np.sin(half) / half
    return squared, chord * np.cos(half), 0.5 * chord * chord
