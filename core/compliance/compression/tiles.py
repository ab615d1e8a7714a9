"""Couplings rounded to steps, in tiles of 8 x 8 numbers of 8 or 16 bits, or none where all vanish.

Orthonormal bases make a rounding error as large in L as it is in the coupling, so a step can be
chosen from the tolerance. The patterns are sorted by importance: most tiles between two clusters
round to nothing or fit 8 bits; only those of the leading patterns need more (adaptive precision).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas, qr

from .cluster_columns import TILE, cluster_softness
from .coupling import Coupling

LARGEST_8_BITS = 127
# The largest float32 that is an int32.
LARGEST_32_BITS = np.float32(2**31 - 128)

# A tile is left out when all that it holds is below this many times the error of rounding it.
NEGLIGIBLE = 1.0


@dataclass(frozen=True, eq=False)
class Rounded:
    """The couplings of one cluster with all earlier ones, rounded.

    Attributes
    ----------
    numbers : float32 (K, k), in steps, whole; zero where a tile is left out.
    used : bool (K / 8, k / 8), which tiles are kept.
    """

    numbers: NDArray[np.float32]
    used: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Rounding:
    """How couplings are rounded.

    Attributes
    ----------
    coupling : what is rounded.
    step : relative to the scale of the softer of two clusters.
    """

    coupling: Coupling
    step: float

    @cached_property
    def steps(self) -> NDArray[np.float32]:
        """For each cluster (q,). The step between two is the smaller one of theirs."""
        softness = cluster_softness(self.coupling.clusters, self.coupling.scale)
        return (self.step / softness).astype(np.float32)

    def rounded(self, cluster: int) -> Rounded:
        """The couplings of a cluster with all earlier ones."""
        return _rounded(self.coupling.blocks[cluster] / self._step_of_rows(cluster))

    def _step_of_rows(self, cluster: int) -> NDArray[np.float32]:
        ranks = [basis.shape[1] for basis in self.coupling.bases[:cluster]]
        return np.repeat(np.minimum(self.steps[:cluster], self.steps[cluster]), ranks)[:, None]

    @cached_property
    def errors(self) -> NDArray[np.float64]:
        """The relative error of each column of L that rounding makes, (3n,), cluster by cluster."""
        clusters, bases = self.coupling.clusters, self.coupling.bases
        ranks = [basis.shape[1] for basis in bases]
        firsts = np.concatenate([[0], np.cumsum(ranks)])
        # |S B x| = |R x|: what a coupling's error is in L, without going through all rows of L.
        shown = [_triangle(self.coupling, cluster) for cluster in range(clusters.count)]
        squares = [np.zeros((rank, rank), np.float32, order="F") for rank in ranks]
        for cluster, exact in enumerate(self.coupling.blocks):
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
        errors = np.empty_like(self.coupling.norms)
        for cluster, (basis, square) in enumerate(zip(bases, squares, strict=True)):
            own = clusters.span(cluster)
            both = square + np.triu(square, 1).T
            squared = np.einsum("ij,jk,ik->i", basis, both, basis, optimize=True)
            errors[own] = self.coupling.scale[own] * np.sqrt(np.maximum(squared, 0.0))
        return errors / self.coupling.norms


def _triangle(coupling: Coupling, cluster: int) -> NDArray[np.float32]:
    basis, own = coupling.bases[cluster], coupling.clusters.span(cluster)
    if not basis.size:
        return np.zeros((0, 0), np.float32)
    (triangle,) = qr(coupling.scale[own, None] * basis, mode="r")
    rank = basis.shape[1]
    square = np.zeros((rank, rank), np.float32, order="F")
    square[: min(rank, len(triangle))] = triangle[:rank]
    return square


def _rounded(stepped: NDArray[np.float32]) -> Rounded:
    rows, columns = stepped.shape
    shape = (rows // TILE, TILE, columns // TILE, TILE)
    energy = np.einsum("aibj,aibj->ab", stepped.reshape(shape), stepped.reshape(shape))
    # Beyond 32 bits they are wrong, and count as such.
    numbers = np.clip(np.rint(stepped), -LARGEST_32_BITS, LARGEST_32_BITS)
    used = energy > NEGLIGIBLE * TILE * TILE / 12
    used &= numbers.reshape(shape).any(axis=(1, 3))
    numbers.reshape(shape)[...] *= used[:, None, :, None]
    return Rounded(numbers, used)
