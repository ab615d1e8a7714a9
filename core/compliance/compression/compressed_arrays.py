"""Arrays of a compressed compliance: clusters, near blocks, bases and rounded interactions."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ...stiffness.freedoms import freedoms

# The rank of a basis is a multiple of this.
TILE = 8


@dataclass(frozen=True, eq=False)
class CompressedArrays:
    """Arrays of a compressed compliance, and how they lie in memory.

    n nodes lie in q clusters of at most a nodes; arrays by cluster are padded to a nodes. Cluster c
    has a basis of rank k_c = 8 t_c; t is the sum of all t_c.

    Attributes
    ----------
    free_surface : int64 (n,), node numbers, ascending.
    tolerance : the largest relative column error that was allowed.
    column_error : float64 (), bound of the largest relative column error, measured on every entry
        of L.
    places : int32 (n,), padded place of a node: its cluster times a, plus its place in the cluster.
    own_blocks : float64 (n, 3, 3), L_ii, exact.
    near_scale : float32 (q, 3a). Near blocks are ``step * near * near_scale * near_scale``.
    near_table : int32 (q, q), number of the block between two clusters from 1 on, 0 for far ones.
    near_steps : float32 (p,).
    near : int16 or float32 (p, 3a, 3a), rows of the cluster of lower number. L_ii is zero here.
    tile_counts : int32 (q,), t_c, ascending.
    basis : float32, (3a, 8 t_c) of each cluster, one after the other. Far blocks are
        ``step * B_r M B_c^T``.
    steps : float32 (q,). The step of M between two clusters is the smaller one of theirs.
    tile_table : int32 (t, t), tile of M: 0 none, i > 0 ``narrow[i]``, i < 0 ``wide[-1 - i]``.
    narrow : int8 (x, 8, 8); the first is zero. Rows are of the cluster of lower number.
    wide : int16 or int32 (y, 8, 8).
    """

    free_surface: NDArray[np.int64]
    tolerance: float
    column_error: NDArray[np.float64]
    places: NDArray[np.int32]
    own_blocks: NDArray[np.float64]
    near_scale: NDArray[np.float32]
    near_table: NDArray[np.int32]
    near_steps: NDArray[np.float32]
    near: NDArray[np.int16] | NDArray[np.float32]
    tile_counts: NDArray[np.int32]
    basis: NDArray[np.float32]
    steps: NDArray[np.float32]
    tile_table: NDArray[np.int32]
    narrow: NDArray[np.int8]
    wide: NDArray[np.int16] | NDArray[np.int32]

    @property
    def node_count(self) -> int:
        """Number of free surface nodes, n."""
        return len(self.free_surface)

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays together."""
        return sum(array.nbytes for array in self.arrays().values())

    def arrays(self) -> dict[str, NDArray[np.generic]]:
        """Arrays for a body file: all but ``free_surface`` and ``tolerance``."""
        return {f"compressed_{name}": getattr(self, name) for name in _stored_names()}

    def __getstate__(self) -> dict[str, object]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def leaf(self) -> int:
        """Nodes of a padded cluster, a."""
        return int(self.near.shape[1]) // 3

    @cached_property
    def rows(self) -> NDArray[np.int64]:
        """Place of each degree of freedom among the padded clusters, (3n,)."""
        return freedoms(self.places.astype(np.int64))

    @cached_property
    def first_tiles(self) -> NDArray[np.int64]:
        """First tile of each cluster, and the number of all, (q + 1,)."""
        return np.concatenate([[0], np.cumsum(self.tile_counts)]).astype(np.int64)

    @cached_property
    def tile_steps(self) -> NDArray[np.float32]:
        """Step of each tile of the bases, (t,)."""
        return np.repeat(self.steps, self.tile_counts)

    @cached_property
    def equal_ranks(self) -> list[tuple[slice, slice, NDArray[np.float32]]]:
        """Clusters of equal rank, their tiles, and their bases (g, 3a, k), views."""
        groups, start = [], 0
        edges = np.flatnonzero(np.diff(self.tile_counts, prepend=-1, append=-1))
        for first, last in pairwise(edges.tolist()):
            rank = TILE * int(self.tile_counts[first])
            stop = start + (last - first) * 3 * self.leaf * rank
            bases = self.basis[start:stop].reshape(last - first, 3 * self.leaf, rank)
            tiles = slice(int(self.first_tiles[first]), int(self.first_tiles[last]))
            groups.append((slice(first, last), tiles, bases))
            start = stop
        return groups

    def cluster_basis(self, cluster: int) -> NDArray[np.float32]:
        """Basis B_c of a cluster, (3a, k), a view."""
        rows = 3 * self.leaf
        start, stop = rows * TILE * self.first_tiles[cluster : cluster + 2]
        return self.basis[start:stop].reshape(rows, -1)

    def place(self, node: int) -> tuple[int, int]:
        """Cluster of a node, and its place inside of it."""
        cluster, inside = divmod(int(self.places[node]), self.leaf)
        return cluster, inside

    def by_cluster(self, nodes: NDArray[np.int64]) -> list[tuple[int, NDArray[np.int64]]]:
        """Clusters that hold some of the nodes, and their entries of ``nodes``."""
        members: dict[int, list[int]] = {}
        for entry, cluster in enumerate((self.places[nodes] // self.leaf).tolist()):
            members.setdefault(cluster, []).append(entry)
        return [(cluster, np.array(entries)) for cluster, entries in members.items()]

    def interaction(self, row: int, column: int) -> NDArray[np.float64]:
        """Interaction M of two clusters, row <= column, in steps, (k_row, k_column)."""
        first, last = self.first_tiles[:-1], self.first_tiles[1:]
        table = self.tile_table[first[row] : last[row], first[column] : last[column]]
        tiles = self.tiles(table.ravel(), np.float64).reshape(*table.shape, TILE, TILE)
        height, width = table.shape
        joined: NDArray[np.float64] = np.empty((TILE * height, TILE * width))
        joined.reshape(height, TILE, width, TILE)[...] = tiles.transpose(0, 2, 1, 3)
        return joined

    def tiles(self, numbers: NDArray[np.int32], dtype: DTypeLike) -> NDArray[np.floating]:
        """Tiles by their entries in the table (m,), (m, 64)."""
        narrow = self.narrow.reshape(-1, TILE * TILE)
        tiles = narrow.take(np.maximum(numbers, 0), axis=0).astype(dtype)
        is_wide = np.flatnonzero(numbers < 0)
        tiles[is_wide] = self.wide.reshape(-1, TILE * TILE)[-1 - numbers[is_wide]]
        return tiles


def _stored_names() -> tuple[str, ...]:
    return tuple(
        field.name
        for field in fields(CompressedArrays)
        if field.name not in {"free_surface", "tolerance"}
    )
