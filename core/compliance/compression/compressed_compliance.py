"""Compliance stored as clusters, near blocks, bases and rounded interactions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas

from ...stiffness.freedoms import freedoms
from .checked_arrays import checked
from .compressed_arrays import TILE, CompressedArrays

if TYPE_CHECKING:
    from palpate_servo import Compliance as NativeCompliance


@dataclass(frozen=True, eq=False)
class CompressedCompliance(CompressedArrays):
    """Compliance in a few percent of the dense memory."""

    form = "compressed"

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
        (row, _), (column, _) = self.place(i), self.place(j)
        (one,) = self._pair_blocks(row, np.array([i]), column, np.array([j]))[0]
        return np.asarray(one)

    def blocks(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """L_ij for every i of ``rows`` (a,) and j of ``columns`` (b,), (a, b, 3, 3)."""
        seen, loaded = (np.asarray(nodes, dtype=np.int64) for nodes in (rows, columns))
        found = np.empty((len(seen), len(loaded), 3, 3))
        for row, a in self.by_cluster(seen):
            for column, b in self.by_cluster(loaded):
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
        a, b = self.places[seen] - row * self.leaf, self.places[loaded] - column * self.leaf
        rows, columns = freedoms(a), freedoms(b)
        number = self.near_table[row, column]
        if not number:
            left = self.cluster_basis(row)[rows].astype(np.float64)
            right = self.cluster_basis(column)[columns].astype(np.float64)
            step = float(min(self.steps[row], self.steps[column]))
            return _as_blocks(step * (left @ self.interaction(row, column) @ right.T))
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
        for cluster, members in self.by_cluster(loaded):
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
            for cluster, members in self.by_cluster(loaded)
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

    def _load(self, cluster: int, nodes: NDArray[np.int64], forces: NDArray[np.float64]) -> _Load:
        inside = self.places[nodes] - cluster * self.leaf
        return _Load(cluster, freedoms(inside), forces)

    def _displacements(
        self, loads: list[_Load], width: int, dtype: type[np.floating]
    ) -> NDArray[np.floating]:
        """Displacements (n, 3, width) under loads, without L_ii of the loaded nodes."""
        moved = np.zeros((len(self.steps), 3 * self.leaf, width), dtype)
        patterns = np.zeros((len(self.tile_steps), TILE, width), dtype)
        for load in loads:
            self._add_near(moved, load)
            self._add_far(patterns, load)
        moved *= self.near_scale[:, :, None]
        for clusters, tiles, bases in self.equal_ranks:
            moved[clusters] += bases @ patterns[tiles].reshape(len(bases), -1, width)
        return moved.reshape(-1, width).take(self.rows, axis=0).reshape(-1, 3, width)

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
        first, last = self.first_tiles[load.cluster : load.cluster + 2]
        if first == last:
            return
        count = int(last - first)
        own = self.cluster_basis(load.cluster)[load.rows].T @ load.forces
        own = own.astype(dtype).reshape(count, TILE, width)
        numbers = np.ascontiguousarray(self.tile_table[first:last].T)
        tiles = self.tiles(numbers.ravel(), dtype).reshape(len(numbers), -1)
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
        steps = np.minimum(self.tile_steps, self.steps[load.cluster])[:, None, None]
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
