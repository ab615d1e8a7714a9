"""Reduction of one cluster's exact columns: near blocks, a basis, the projected far part.

Everything is scaled, s_i being about the norm of column i, so that errors are relative to their
column, of a soft ear as of a stiff foot. Far parts are
L_ij / (s_i s_j); near blocks, where L_ii and L_jj set the size of L_ij, are L_ij / sqrt(s_i s_j).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas, eigh

from ...errors import PalpateError
from .clusters import Clusters
from .column_source import ColumnSource
from .compressed_arrays import TILE

LARGEST_16_BITS = 32_767

# Clusters whose scale is estimated together: as many columns as a largest cluster has.
SAMPLED_AT_ONCE = 32


@dataclass(frozen=True, eq=False)
class NearBlock:
    """Full block between two neighbours: ``step * numbers`` (3a, 3b), scaled."""

    row: int
    numbers: NDArray[np.int16] | NDArray[np.float32]
    step: float


@dataclass(frozen=True, eq=False)
class ClusterColumns:
    """Reduced columns of a cluster.

    Attributes
    ----------
    diagonal : (a, 3, 3), the cluster's own blocks L_ii, exact, not scaled.
    norms : (3a,), of the full columns, exact.
    near : blocks with this cluster and with earlier neighbours; the 3 x 3 diagonal is zero in them.
    basis : (3a, k) orthonormal columns, the most important first, and zeros until k is a multiple
        of 8.
    projected : float32 (rows of all earlier clusters, k), the far part times the basis.
    near_error, cut_error : (rows of earlier clusters and of this one,), squared error that rounding
        near blocks and cutting the basis bring to those columns of L.
    """

    diagonal: NDArray[np.float64]
    norms: NDArray[np.float64]
    near: tuple[NearBlock, ...]
    basis: NDArray[np.float64]
    projected: NDArray[np.float32]
    near_error: NDArray[np.float64]
    cut_error: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ClusterTask:
    """Reduction of a cluster, to be called with its number; picklable.

    Attributes
    ----------
    source : the exact columns.
    clusters : the partition.
    scale : (3n,), s of each degree of freedom, cluster after cluster.
    cut : largest relative column error by which the basis may fall short.
    near_in_16_bits : near blocks as steps of their largest number / 32767, else float32.
    """

    source: ColumnSource
    clusters: Clusters
    scale: NDArray[np.float64]
    cut: float
    near_in_16_bits: bool

    def __call__(self, cluster: int) -> ClusterColumns:
        """Solve for the cluster's columns and reduce them."""
        nodes, own = self.clusters.members[cluster], self.clusters.span(cluster)
        exact = self.source.columns(nodes)[self.clusters.freedoms]
        norms = np.sqrt(np.einsum("ij,ij->j", exact, exact))
        if not (np.isfinite(norms).all() and norms.all()):
            raise PalpateError(
                "compliance: columns vanish or are not finite, so they cannot be compressed; take "
                "another mesh or stiffness factors less far apart"
            )
        corners = exact[own].reshape(len(nodes), 3, len(nodes), 3)
        each = np.arange(len(nodes))
        diagonal = corners[each, :, each, :]
        scaled = np.asfortranarray(exact / self.scale[:, None])
        scaled /= self.scale[own]
        near_error = np.zeros(own.stop)
        near = self._near_blocks(cluster, exact, near_error)
        basis = self._basis(cluster, scaled)
        earlier = np.asfortranarray(scaled[: own.start])
        is_near = self.clusters.near[:cluster, cluster]
        earlier[np.repeat(is_near, np.diff(self.clusters.starts[: cluster + 1]))] = 0.0
        projected, cut_error = self._projected(earlier, basis, own)
        return ClusterColumns(
            diagonal=0.5 * (diagonal + diagonal.transpose(0, 2, 1)),
            norms=norms,
            near=tuple(near),
            basis=basis,
            projected=projected,
            near_error=near_error,
            cut_error=cut_error,
        )

    def _near_blocks(
        self, cluster: int, exact: NDArray[np.float64], error: NDArray[np.float64]
    ) -> list[NearBlock]:
        own, blocks = self.clusters.span(cluster), []
        root = np.sqrt(self.scale)
        for row in np.flatnonzero(self.clusters.near[: cluster + 1, cluster]):
            rows = self.clusters.span(int(row))
            block = exact[rows] / (root[rows, None] * root[own])
            if row == cluster:
                block = 0.5 * (block + block.T)
                size = len(block) // 3
                each = np.arange(size)
                block.reshape(size, 3, size, 3)[each, :, each, :] = 0.0
            kept = self._kept(int(row), block)
            blocks.append(kept)
            missing = block - kept.step * kept.numbers.astype(np.float64)
            missing *= root[rows, None] * root[own]
            missing *= missing
            error[own] += missing.sum(axis=0)
            if row != cluster:
                error[rows] += missing.sum(axis=1)
        return blocks

    def _kept(self, row: int, block: NDArray[np.float64]) -> NearBlock:
        if not self.near_in_16_bits:
            return NearBlock(row, block.astype(np.float32), 1.0)
        step = float(np.float32(np.abs(block).max() / LARGEST_16_BITS))
        if step == 0.0:
            return NearBlock(row, np.zeros(block.shape, np.int16), 1.0)
        rounded = np.clip(np.rint(block / step), -LARGEST_16_BITS, LARGEST_16_BITS)
        return NearBlock(row, rounded.astype(np.int16), step)

    def _basis(self, cluster: int, scaled: NDArray[np.float64]) -> NDArray[np.float64]:
        """Leading eigenvectors of the far part's Gram matrix, as many as its columns need.

        A block may err by a share of the softer cluster's scale: then it is right for both.
        """
        softest = cluster_softness(self.clusters, self.scale)
        weights = np.maximum(softest, softest[cluster]) * ~self.clusters.near[:, cluster]
        far = np.asfortranarray(scaled * self.clusters.spread(weights)[:, None])
        gram = blas.dsyrk(1.0, far, trans=1, lower=1)
        energies, vectors = eigh(gram, lower=True)
        # What remains of each column's squared length without the first k vectors, k = 0, 1, ...
        without = np.cumsum(np.maximum(energies, 0.0) * vectors**2, axis=1)[:, ::-1]
        needed = int(np.count_nonzero(without.max(axis=0) > self.cut**2))
        basis = np.zeros((len(energies), -(-needed // TILE) * TILE), order="F")
        filled = min(basis.shape[1], len(energies))
        basis[:, :filled] = vectors[:, ::-1][:, :filled]
        return basis

    def _projected(
        self, earlier: NDArray[np.float64], basis: NDArray[np.float64], own: slice
    ) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
        error = np.zeros(own.stop)
        if not (earlier.size and basis.size):
            projected = np.zeros((len(earlier), basis.shape[1]), np.float32)
        else:
            projected = blas.dgemm(1.0, earlier, basis).astype(np.float32)
            earlier = blas.dgemm(
                -1.0, projected.astype(np.float64), basis, 1.0, earlier, trans_b=1, overwrite_c=1
            )
        earlier *= self.scale[: own.start, None]
        earlier *= self.scale[own]
        earlier *= earlier
        error[own] = earlier.sum(axis=0)
        error[: own.start] = earlier.sum(axis=1)
        return projected, error


def cluster_softness(clusters: Clusters, scale: NDArray[np.float64]) -> NDArray[np.float64]:
    """The largest scale in each cluster, (q,)."""
    softest: NDArray[np.float64] = np.maximum.reduceat(scale, clusters.starts[:-1])
    return softest


def estimated_scale(source: ColumnSource, clusters: Clusters) -> NDArray[np.float64]:
    """About the norm of every column of L, (3n,), cluster after cluster, from one node a cluster.

    L is symmetric, so a row over a sample of columns estimates a column's part in far clusters. The
    near part peaks where such a row may miss it, and is taken from the sampled column, scaled by
    L_ii. Only the choice of bases and steps depends on it; errors are measured on exact columns.
    """
    sample = np.array([nodes[len(nodes) // 2] for nodes in clusters.members])
    sizes = np.diff(clusters.starts) // 3
    peaks = np.sum(source.diagonal() ** 2, axis=1)
    far = np.zeros(len(clusters.freedoms))
    near = np.empty((clusters.count, 3))
    for first in range(0, clusters.count, SAMPLED_AT_ONCE):
        part = slice(first, first + SAMPLED_AT_ONCE)
        squares = source.columns(sample[part])[clusters.freedoms] ** 2
        is_near = np.repeat(clusters.near[:, part], 3 * sizes, axis=0).repeat(3, axis=1)
        near[part] = squares.sum(axis=0, where=is_near).reshape(-1, 3)
        squares[is_near] = 0.0
        far += squares @ np.repeat(sizes[part].astype(np.float64), 3)
    near_to_peak = np.repeat(near / peaks[sample], sizes, axis=0).ravel()
    estimated: NDArray[np.float64] = np.sqrt(far + near_to_peak * peaks.ravel()[clusters.freedoms])
    return estimated
