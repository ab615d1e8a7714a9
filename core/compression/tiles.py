"""Couplings rounded to steps, in tiles of 8 x 8 numbers of 8 or 16 bits, or none where all vanish.

Orthonormal bases make a rounding error as large in L as it is in the coupling, so a step can be
chosen from the tolerance. The patterns are sorted by importance: most tiles between two clusters
round to nothing or fit 8 bits; only those of the leading patterns need more (adaptive precision).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas, qr

from .cluster_columns import TILE, cluster_softness
from .coupling import Coupling

LARGEST_8_BITS = 127

# A tile is left out when all that it holds is below this many times the error of rounding it.
NEGLIGIBLE = 1.0


@dataclass(frozen=True, eq=False)
class Rounded:
    """The couplings of one cluster with all earlier ones, rounded.

    Attributes
    ----------
    numbers : int32 (K, k), in steps; zero where a tile is left out.
    used : bool (K / 8, k / 8), which tiles are kept.
    """

    numbers: NDArray[np.int32]
    used: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Rounding:
    """How couplings are rounded, and what that costs.

    Attributes
    ----------
    step : relative to the softness of the softer of two clusters.
    steps : float32 (q,). The step between clusters r and c is the smaller one of theirs.
    coupled : for each cluster, its couplings with earlier ones.
    errors : (3n,), relative error of each column of L that rounding makes.
    """

    step: float
    steps: NDArray[np.float32]
    coupled: tuple[Rounded, ...]
    errors: NDArray[np.float64]


def rounding(coupling: Coupling, step: float) -> Rounding:
    """Round all couplings to ``step`` relative to the softer of both clusters."""
    clusters, bases = coupling.clusters, coupling.bases
    softness = cluster_softness(clusters, coupling.scale)
    steps = (step / softness).astype(np.float32)
    ranks = [basis.shape[1] for basis in bases]
    firsts = np.concatenate([[0], np.cumsum(ranks)])
    # |S B x| = |R x|: how a coupling's error shows in L's columns, without the cluster's size.
    shown = [_triangle(coupling, cluster) for cluster in range(clusters.count)]
    squares = [np.zeros((rank, rank), np.float32, order="F") for rank in ranks]
    coupled = []
    for cluster, exact in enumerate(coupling.blocks):
        stepped = np.repeat(np.minimum(steps[:cluster], steps[cluster]), ranks[:cluster])
        rounded = _rounded(exact / stepped[:, None])
        coupled.append(rounded)
        if not exact.size:
            continue
        error = exact - stepped[:, None] * rounded.numbers.astype(np.float32)
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
    errors = np.empty_like(coupling.norms)
    for cluster, (basis, square) in enumerate(zip(bases, squares, strict=True)):
        own = clusters.span(cluster)
        both = square + np.triu(square, 1).T
        squared = np.einsum("ij,jk,ik->i", basis, both, basis, optimize=True)
        errors[own] = coupling.scale[own] * np.sqrt(np.maximum(squared, 0.0))
    return Rounding(step, steps, tuple(coupled), errors / coupling.norms)


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
    numbers = np.rint(stepped).astype(np.int32)
    used = energy > NEGLIGIBLE * TILE * TILE / 12
    used &= numbers.reshape(shape).any(axis=(1, 3))
    numbers.reshape(shape)[...] *= used[:, None, :, None]
    return Rounded(numbers, used)
