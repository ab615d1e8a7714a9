"""The upper half of a symmetric matrix in contiguous tiles, so that BLAS works on it in place.

The wrappers of BLAS in scipy take whole arrays only; a part of a larger array would be copied. They
are handed one tile of a large Schur complement at a time, which also keeps every call short.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dgemm, dsyrk

# Rows and columns of a tile. Products of a few hundred run at full speed.
TILE = 512


@dataclass(frozen=True, eq=False)
class UpperTiles:
    """A symmetric (m, m) matrix, of which the entries on and above the diagonal count.

    Attributes
    ----------
    edges : where each block of rows or columns begins, and m at the end.
    tiles : ``tiles[k][i]`` for i up to k holds rows of block i and columns of block k. Diagonal
        tiles are square; below their own diagonal they hold anything finite.
    """

    edges: tuple[int, ...]
    tiles: tuple[tuple[NDArray[np.float64], ...], ...]

    @classmethod
    def zeros(cls, size: int, tile: int = TILE) -> UpperTiles:
        """A matrix of zeros, (size, size)."""
        edges = tile_edges(size, tile)
        widths = np.diff(edges)
        return cls(
            edges,
            tuple(
                tuple(np.zeros((height, width), order="F") for height in widths[: column + 1])
                for column, width in enumerate(widths)
            ),
        )

    @property
    def size(self) -> int:
        """How many numbers the tiles hold."""
        return sum(tile.size for column in self.tiles for tile in column)

    def subtract_gram(self, panel: NDArray[np.float64], done: Callable[[float], None]) -> None:
        """Subtract ``panel.T @ panel``; panel is (k, m) and Fortran-ordered.

        ``done`` is told the floating point operations of each call when it ends.
        """
        parts = [panel[:, a:b] for a, b in pairwise(self.edges)]
        for column, right in enumerate(parts):
            for row, left in enumerate(parts[:column]):
                tile = self.tiles[column][row]
                dgemm(-1.0, left, right, 1.0, tile, trans_a=True, overwrite_c=True)
                done(2.0 * left.size * right.shape[1])
            dsyrk(-1.0, right, 1.0, self.tiles[column][column], trans=True, overwrite_c=True)
            done(1.0 * right.size * right.shape[1])

    def dense(self) -> NDArray[np.float64]:
        """The whole matrix, (m, m), both halves."""
        upper = np.zeros((self.edges[-1],) * 2)
        for column, stack in enumerate(self.tiles):
            columns = slice(*self.edges[column : column + 2])
            for row, tile in enumerate(stack):
                upper[slice(*self.edges[row : row + 2]), columns] = tile
        upper = np.triu(upper)
        return upper + np.triu(upper, 1).T


def tile_edges(size: int, tile: int = TILE) -> tuple[int, ...]:
    """Where blocks of at most ``tile`` begin along ``size`` rows, and ``size`` itself."""
    return (*range(0, size, tile), size)
