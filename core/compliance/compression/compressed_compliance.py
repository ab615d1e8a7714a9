"""Compliance stored as clusters, near blocks, bases and rounded interactions."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import DTypeLike, NDArray
from scipy.linalg import blas

from ...stiffness.freedoms import freedoms

if TYPE_CHECKING:
    from palpate_servo import Compliance as NativeCompliance

TILE = 8


@dataclass(frozen=True, eq=False)
class CompressedCompliance:
    """Compliance in a few percent of the dense memory.

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

    form = "compressed"

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

    @classmethod
    def from_arrays(
        cls,
        free_surface: NDArray[np.int64],
        arrays: dict[str, NDArray[np.generic]],
        tolerance: float,
    ) -> Self:
        """The compliance that :meth:`arrays` came from; other keys are left alone.

        Raises
        ------
        PalpateError
            Arrays that are missing, or do not belong together.
        """
        from .checked_arrays import checked

        parts = checked(len(free_surface), arrays)
        return cls(free_surface=free_surface, tolerance=tolerance, **parts)

    def block(self, i: int, j: int) -> NDArray[np.float64]:
        """L_ij, (3, 3): displacement of node i per force on node j."""
        if i == j:
            own: NDArray[np.float64] = self.own_blocks[i].copy()
            return own
        # The other half is the transpose, so that L is symmetric to the last bit.
        if self.places[i] > self.places[j]:
            return self.block(j, i).T
        (row, _), (column, _) = self._place(i), self._place(j)
        (one,) = self._pair_blocks(row, np.array([i]), column, np.array([j]))[0]
        return np.asarray(one)

    def blocks(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """L_ij for every i of ``rows`` (a,) and j of ``columns`` (b,), (a, b, 3, 3)."""
        seen, loaded = (np.asarray(nodes, dtype=np.int64) for nodes in (rows, columns))
        found = np.empty((len(seen), len(loaded), 3, 3))
        for row, a in self._by_cluster(seen):
            for column, b in self._by_cluster(loaded):
                if row <= column:
                    found[np.ix_(a, b)] = self._pair_blocks(row, seen[a], column, loaded[b])
                else:
                    turned = self._pair_blocks(column, loaded[b], row, seen[a])
                    found[np.ix_(a, b)] = turned.transpose(1, 0, 3, 2)
        same = np.nonzero(seen[:, None] == loaded)
        found[same] = self.own_blocks[seen[same[0]]]
        return found

    def _pair_blocks(
        self, row: int, seen: NDArray[np.int64], column: int, loaded: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """L_ij between nodes of cluster ``row`` and of ``column`` >= ``row``, (a, b, 3, 3)."""
        a, b = self.places[seen] - row * self._leaf, self.places[loaded] - column * self._leaf
        rows, columns = freedoms(a), freedoms(b)
        number = self.near_table[row, column]
        if not number:
            left = self._cluster_basis(row)[rows].astype(np.float64)
            right = self._cluster_basis(column)[columns].astype(np.float64)
            step = float(min(self.steps[row], self.steps[column]))
            return _as_blocks(step * (left @ self._interaction(row, column) @ right.T))
        near, step = self.near[number - 1], float(self.near_steps[number - 1])
        scale = self.near_scale.astype(np.float64)
        sides = scale[row, rows, None] * scale[column, columns]
        straight = _as_blocks(sides * (step * near[np.ix_(rows, columns)].astype(np.float64)))
        if row != column:
            return straight
        # Both orders are stored within one cluster; the order of places counts, as in `block`.
        turned = _as_blocks(sides * (step * near[np.ix_(columns, rows)].T.astype(np.float64)))
        is_turned = (a[:, None] > b)[:, :, None, None]
        return np.where(is_turned, turned, straight)

    def diagonal(self) -> NDArray[np.float64]:
        """All blocks L_ii, (n, 3, 3)."""
        return self.own_blocks.copy()

    def columns(self, nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        """The columns of L for forces on ``nodes`` (k,), as a matrix (3n, 3k)."""
        loaded = np.asarray(nodes, dtype=np.int64)
        columns = np.empty((self.node_count, 3, 3 * len(loaded)))
        for cluster, members in self._by_cluster(loaded):
            own = freedoms(members)
            load = self._load(cluster, loaded[members], np.eye(len(own)))
            columns[:, :, own] = self._displacements([load], len(own), np.float64)
        each = 3 * np.arange(len(loaded))
        for axis in range(3):
            columns[loaded, :, each + axis] += self.own_blocks[loaded, :, axis]
        return columns.reshape(3 * self.node_count, -1)

    def apply(
        self, nodal_forces: NDArray[np.float64], nodes: NDArray[np.int64] | None = None
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) under ``nodal_forces`` (k, 3) on ``nodes`` (k,); equation (15).

        Without ``nodes`` there is one force for every node, (n, 3). Summed in float32, L_ii F_i
        in float64; natively where the servo is installed.
        """
        loaded = np.arange(self.node_count) if nodes is None else np.asarray(nodes, dtype=np.int64)
        forces = np.asarray(nodal_forces, dtype=np.float64).reshape(-1, 3)
        if self._native is not None:
            return self._native.apply(forces, loaded)
        return self._applied(forces, loaded)

    def _applied(
        self, forces: NDArray[np.float64], loaded: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        loads = [
            self._load(cluster, loaded[members], forces[members].reshape(-1, 1))
            for cluster, members in self._by_cluster(loaded)
        ]
        moved = self._displacements(loads, 1, np.float32)[:, :, 0].astype(np.float64)
        np.add.at(moved, loaded, (self.own_blocks[loaded] @ forces[:, :, None])[:, :, 0])
        return moved

    @cached_property
    def _native(self) -> NativeCompliance | None:
        """The same arrays in native code, about twice as fast; makes them read-only."""
        try:
            from palpate_servo import Compliance
        except ImportError:
            return None
        return Compliance.compressed(self.arrays())

    def __getstate__(self) -> dict[str, object]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def _leaf(self) -> int:
        return int(self.near.shape[1]) // 3

    @cached_property
    def _rows(self) -> NDArray[np.int64]:
        """Place of each degree of freedom among the padded clusters, (3n,)."""
        return freedoms(self.places.astype(np.int64))

    @cached_property
    def _first_tiles(self) -> NDArray[np.int64]:
        return np.concatenate([[0], np.cumsum(self.tile_counts)]).astype(np.int64)

    @cached_property
    def _tile_steps(self) -> NDArray[np.float32]:
        return np.repeat(self.steps, self.tile_counts)

    @cached_property
    def _equal_ranks(self) -> list[tuple[slice, slice, NDArray[np.float32]]]:
        """Clusters of equal rank, their tiles, and their bases (g, 3a, k), views."""
        groups, start = [], 0
        edges = np.flatnonzero(np.diff(self.tile_counts, prepend=-1, append=-1))
        for first, last in pairwise(edges.tolist()):
            rank = TILE * int(self.tile_counts[first])
            stop = start + (last - first) * 3 * self._leaf * rank
            bases = self.basis[start:stop].reshape(last - first, 3 * self._leaf, rank)
            tiles = slice(int(self._first_tiles[first]), int(self._first_tiles[last]))
            groups.append((slice(first, last), tiles, bases))
            start = stop
        return groups

    def _cluster_basis(self, cluster: int) -> NDArray[np.float32]:
        """Basis B_c of a cluster, (3a, k), a view."""
        rows = 3 * self._leaf
        start, stop = rows * TILE * self._first_tiles[cluster : cluster + 2]
        return self.basis[start:stop].reshape(rows, -1)

    def _place(self, node: int) -> tuple[int, int]:
        cluster, inside = divmod(int(self.places[node]), self._leaf)
        return cluster, inside

    def _by_cluster(self, nodes: NDArray[np.int64]) -> list[tuple[int, NDArray[np.int64]]]:
        """Clusters that hold some of the nodes, and their entries of ``nodes``."""
        members: dict[int, list[int]] = {}
        for entry, cluster in enumerate((self.places[nodes] // self._leaf).tolist()):
            members.setdefault(cluster, []).append(entry)
        return [(cluster, np.array(entries)) for cluster, entries in members.items()]

    def _load(self, cluster: int, nodes: NDArray[np.int64], forces: NDArray[np.float64]) -> _Load:
        inside = self.places[nodes] - cluster * self._leaf
        return _Load(cluster, freedoms(inside), forces)

    def _interaction(self, row: int, column: int) -> NDArray[np.float64]:
        """Interaction M of two clusters, row <= column, in steps, (k_row, k_column)."""
        first, last = self._first_tiles[:-1], self._first_tiles[1:]
        table = self.tile_table[first[row] : last[row], first[column] : last[column]]
        tiles = self._tiles(table.ravel(), np.float64).reshape(*table.shape, TILE, TILE)
        height, width = table.shape
        joined: NDArray[np.float64] = np.empty((TILE * height, TILE * width))
        joined.reshape(height, TILE, width, TILE)[...] = tiles.transpose(0, 2, 1, 3)
        return joined

    def _tiles(self, numbers: NDArray[np.int32], dtype: DTypeLike) -> NDArray[np.floating]:
        """Tiles by their entries in the table (m,), (m, 64)."""
        narrow = self.narrow.reshape(-1, TILE * TILE)
        tiles = narrow.take(np.maximum(numbers, 0), axis=0).astype(dtype)
        is_wide = np.flatnonzero(numbers < 0)
        tiles[is_wide] = self.wide.reshape(-1, TILE * TILE)[-1 - numbers[is_wide]]
        return tiles

    def _displacements(
        self, loads: list[_Load], width: int, dtype: type[np.floating]
    ) -> NDArray[np.floating]:
        """Displacements (n, 3, width) under loads, without L_ii of the loaded nodes."""
        moved = np.zeros((len(self.steps), 3 * self._leaf, width), dtype)
        patterns = np.zeros((len(self._tile_steps), TILE, width), dtype)
        for load in loads:
            self._add_near(moved, load)
            self._add_far(patterns, load)
        moved *= self.near_scale[:, :, None]
        for clusters, tiles, bases in self._equal_ranks:
            moved[clusters] += bases @ patterns[tiles].reshape(len(bases), -1, width)
        return moved.reshape(-1, width).take(self._rows, axis=0).reshape(-1, 3, width)

    def _add_near(self, moved: NDArray[np.floating], load: _Load) -> None:
        numbers = self.near_table[load.cluster]
        others = np.flatnonzero(numbers)
        blocks = numbers[others].astype(np.int64) - 1
        forces = self.near_scale[load.cluster, load.rows, None] * load.forces
        steps = self.near_steps[blocks, None, None]
        # Blocks are stored once: for a later cluster, rows and columns are swapped.
        turn = int(np.searchsorted(others, load.cluster))
        size, width = moved.shape[1:]
        each_row = size * (size * blocks[:turn, None] + np.arange(size))
        straight = self.near.reshape(-1).take(each_row.reshape(-1, 1) + load.rows)
        turned = self.near.reshape(-1, size).take(size * blocks[turn:] + load.rows[:, None], axis=0)
        forces = forces.astype(moved.dtype)
        by_columns = straight.astype(moved.dtype) @ forces
        by_rows = turned.reshape(len(forces), -1).astype(moved.dtype).T @ forces
        moved[others[:turn]] += steps[:turn] * by_columns.reshape(-1, size, width)
        moved[others[turn:]] += steps[turn:] * by_rows.reshape(-1, size, width)

    def _add_far(self, patterns: NDArray[np.floating], load: _Load) -> None:
        dtype, width = patterns.dtype, patterns.shape[2]
        first, last = self._first_tiles[load.cluster : load.cluster + 2]
        if first == last:
            return
        count = int(last - first)
        own = self._cluster_basis(load.cluster)[load.rows].T @ load.forces
        own = own.astype(dtype).reshape(count, TILE, width)
        numbers = np.ascontiguousarray(self.tile_table[first:last].T)
        tiles = self._tiles(numbers.ravel(), dtype).reshape(len(numbers), -1)
        multiply = blas.sgemm if dtype == np.float32 else blas.dgemm
        # Products of all tiles, or their transposes, with a part of `own`, in one call:
        # the tile's 64 numbers as a row, times the part repeated along an identity.
        each = np.arange(TILE)
        weights = np.zeros((count, TILE, TILE, TILE, width), dtype)
        weights[:, each, :, each] = own
        straight = multiply(1.0, weights.reshape(-1, TILE * width).T, tiles[:first].T)
        weights[:] = 0.0
        weights[:, :, each, each] = own[:, :, None]
        turned = multiply(1.0, weights.reshape(-1, TILE * width).T, tiles[first:].T)
        steps = np.minimum(self._tile_steps, self.steps[load.cluster])[:, None, None]
        patterns[:first] += steps[:first] * straight.T.reshape(-1, TILE, width)
        patterns[first:] += steps[first:] * turned.T.reshape(-1, TILE, width)


def _as_blocks(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """A matrix (3a, 3b) as its blocks (a, b, 3, 3)."""
    rows, columns = matrix.shape
    return matrix.reshape(rows // 3, 3, columns // 3, 3).transpose(0, 2, 1, 3)


@dataclass(frozen=True, eq=False)
class _Load:
    """Forces (r, width) on rows (r,) of a cluster."""

    cluster: int
    rows: NDArray[np.int64]
    forces: NDArray[np.float64]


def _stored_names() -> tuple[str, ...]:
    return tuple(
        field.name
        for field in fields(CompressedCompliance)
        if field.name not in {"free_surface", "tolerance"}
    )
