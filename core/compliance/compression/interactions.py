"""Interactions between the bases of all clusters, collected as the clusters' columns arrive."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas

from .cluster_columns import ClusterColumns, NearBlock
from .clusters import Clusters


@dataclass(eq=False)
class Interactions:
    """L between far clusters r < c as B_r M_rc B_c^T, and the error of that.

    Clusters are added in order: when c arrives, the bases of all r before it are known, and the
    other half follows from symmetry; so each column is computed once and not kept.

    Attributes
    ----------
    clusters, scale : the partition, and s of each degree of freedom, cluster after cluster.
    bases : (3a, k) for each cluster added.
    blocks : for each, M of all earlier clusters, stacked, float32.
    near : for each, the near blocks with earlier clusters and itself.
    diagonals : for each, its blocks L_ii.
    norms : of the columns of L.
    near_error : squared error of each column from rounding near blocks.
    own_cut, other_cut : squared error of each column from cutting its own cluster's basis, and
        the others'.
    """

    clusters: Clusters
    scale: NDArray[np.float64]
    bases: list[NDArray[np.float64]] = field(default_factory=list)
    blocks: list[NDArray[np.float32]] = field(default_factory=list)
    near: list[tuple[NearBlock, ...]] = field(default_factory=list)
    diagonals: list[NDArray[np.float64]] = field(default_factory=list)
    norms: NDArray[np.float64] = field(init=False)
    near_error: NDArray[np.float64] = field(init=False)
    own_cut: NDArray[np.float64] = field(init=False)
    other_cut: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        self.norms = np.ones_like(self.scale)
        self.near_error = np.zeros_like(self.scale)
        self.own_cut = np.zeros_like(self.scale)
        self.other_cut = np.zeros_like(self.scale)

    def add(self, part: ClusterColumns) -> None:
        """Add the next cluster."""
        cluster = len(self.bases)
        own = self.clusters.span(cluster)
        self.norms[own] = part.norms
        self.near_error[: own.stop] += part.near_error
        self.own_cut[: own.stop] += part.cut_error
        self._project(cluster, part)
        self.bases.append(part.basis)
        self.near.append(part.near)
        self.diagonals.append(part.diagonal)

    def _project(self, cluster: int, part: ClusterColumns) -> None:
        own, first = self.clusters.span(cluster), 0
        rank = part.basis.shape[1]
        blocks = np.zeros((sum(basis.shape[1] for basis in self.bases), rank), np.float32)
        missing = part.projected.astype(np.float64)
        for row, basis in enumerate(self.bases):
            last = first + basis.shape[1]
            if not self.clusters.near[row, cluster] and basis.shape[1] and rank:
                rows = self.clusters.span(row)
                between = blas.dgemm(1.0, basis, missing[rows], trans_a=1).astype(np.float32)
                blocks[first:last] = between
                missing[rows] -= blas.dgemm(1.0, basis, between.astype(np.float64))
            first = last
        self.blocks.append(blocks)
        if missing.size:
            left_out = blas.dgemm(1.0, missing, part.basis, trans_b=1)
            left_out *= self.scale[: own.start, None]
            left_out *= self.scale[own]
            left_out *= left_out
            self.other_cut[own] += left_out.sum(axis=0)
            self.other_cut[: own.start] += left_out.sum(axis=1)

    def cut_errors(self) -> NDArray[np.float64]:
        """Bound of each column's relative error from cut bases, (3n,)."""
        return (np.sqrt(self.own_cut) + np.sqrt(self.other_cut)) / self.norms
