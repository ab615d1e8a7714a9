"""Interactions rounded to steps, in tiles of 8 x 8 numbers of 8 or 16 bits, without zero tiles.

With orthonormal bases a rounding error is as large in L as in the interaction, so the step follows
from the tolerance. Basis vectors are sorted by importance: most tiles vanish or fit 8 bits; only
those of the leading vectors need more (adaptive precision).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas, qr

from .cluster_columns import cluster_softness
from .compressed_arrays import TILE
from .interactions import Interactions

LARGEST_8_BITS = 127
# Largest float32 that is an int32.
LARGEST_32_BITS = np.float32(2**31 - 128)

# A tile is left out if its norm is below this many times its rounding error.
NEGLIGIBLE = 1.0


@dataclass(frozen=True, eq=False)
class Rounded:
    """Rounded interactions of one cluster with all earlier ones.

    Attributes
    ----------
    numbers : float32 (K, k), integers, in steps; zero where a tile is left out.
    used : bool (K / 8, k / 8), mask of the tiles kept.
    """

    numbers: NDArray[np.float32]
    used: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Rounding:
    """Rounding of interactions.

    Attributes
    ----------
    interactions : before rounding.
    step : relative to the scale of the softer of two clusters.
    """

    interactions: Interactions
    step: float

    @cached_property
    def steps(self) -> NDArray[np.float32]:
        """Step of each cluster, (q,); between two clusters the smaller one counts."""
        softness = cluster_softness(self.interactions.clusters, self.interactions.scale)
        return (self.step / softness).astype(np.float32)

    def rounded(self, cluster: int) -> Rounded:
        """Rounded interactions of a cluster with all earlier ones."""
        return _rounded(self.interactions.blocks[cluster] / self._step_of_rows(cluster))

    def _step_of_rows(self, cluster: int) -> NDArray[np.float32]:
        ranks = [basis.shape[1] for basis in self.interactions.bases[:cluster]]
        return np.repeat(np.minimum(self.steps[:cluster], self.steps[cluster]), ranks)[:, None]

    @cached_property
    def errors(self) -> NDArray[np.float64]:
        """Relative error of each column of L from rounding, (3n,), cluster by cluster."""
        clusters, bases = self.interactions.clusters, self.interactions.bases
        ranks = [basis.shape[1] for basis in bases]
        firsts = np.concatenate([[0], np.cumsum(ranks)])
        # |S B x| = |R x|: the error in L of an interaction's error, without all rows of L.
        shown = [_triangle(self.interactions, cluster) for cluster in range(clusters.count)]
        squares = [np.zeros((rank, rank), np.float32, order="F") for rank in ranks]
        for cluster, exact in enumerate(self.interactions.blocks):
            if not exact.size:
                continue
            error = exact - self._step_of_rows(cluster) * self.rounded(cluster).numbers
            right = blas.sgemm(1.0, shown[cluster], error.T)
            left = np.zeros(error.T.shape, np.float32, order="F")
            for row in np.flatnonzero(~clusters.near[:cluster, cluster]):
                part = slice(firsts[row], firsts[row + 1])
                if ranks[row]:
                    left[:, part] = blas.sgemm(1.0, error[part].T, shown[row], trans_b=1)
                    squares[row] = blas.ssyrk(
                        1.0, right[:, part], 1.0, squares[row], trans=1, overwrite_c=1
                    )
            squares[cluster] = blas.ssyrk(1.0, left, 1.0, squares[cluster], overwrite_c=1)
        errors = np.empty_like(self.interactions.norms)
        for cluster, (basis, square) in enumerate(zip(bases, squares, strict=True)):
            own = clusters.span(cluster)
            both = square + np.triu(square, 1).T
            squared = np.einsum("ij,jk,ik->i", basis, both, basis, optimize=True)
            errors[own] = self.interactions.scale[own] * np.sqrt(np.maximum(squared, 0.0))
        return errors / self.interactions.norms


def _triangle(interactions: Interactions, cluster: int) -> NDArray[np.float32]:
    basis, own = interactions.bases[cluster], interactions.clusters.span(cluster)
    if not basis.size:
        return np.zeros((0, 0), np.float32)
    (triangle,) = qr(interactions.scale[own, None] * basis, mode="r")
    rank = basis.shape[1]
    square = np.zeros((rank, rank), np.float32, order="F")
    square[: min(rank, len(triangle))] = triangle[:rank]
    return square


def _rounded(stepped: NDArray[np.float32]) -> Rounded:
    rows, columns = stepped.shape
    shape = (rows // TILE, TILE, columns // TILE, TILE)
    energy = np.einsum("aibj,aibj->ab", stepped.reshape(shape), stepped.reshape(shape))
    # Clipped to 32 bits, and counted as errors.
    numbers = np.clip(np.rint(stepped), -LARGEST_32_BITS, LARGEST_32_BITS)
    used = energy > NEGLIGIBLE * TILE * TILE / 12
    used &= numbers.reshape(shape).any(axis=(1, 3))
    numbers.reshape(shape)[...] *= used[:, None, :, None]
    return Rounded(numbers, used)
