"""Upper half of a symmetric matrix in contiguous tiles, so that BLAS works on it in place.

SciPy's BLAS wrappers copy parts of larger arrays; one tile at a time is not copied, and every call
is short.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dgemm, dsyrk

from ...machine.available_memory import zeros_apart

# Rows and columns of a tile, enough for products at full speed.
TILE = 512


class UpperTiles:
    """Symmetric (m, m) matrix, given by the entries on and above the diagonal.

    Its columns are made and given up one block after another, so that of two matrices of which one
    goes over into the other never both are held in full.

    Parameters
    ----------
    size, tile : m, and rows and columns of a tile at most.

    Attributes
    ----------
    edges : start of each block of rows or columns, and m.
    tiles : ``tiles[k][i]`` for i up to k holds rows of block i and columns of block k. Diagonal
        tiles are square, with anything finite below their diagonal. Columns that are not made yet
        are missing at the end; of those given up nothing is left.
    """

    def __init__(self, size: int, tile: int = TILE) -> None:
        self.edges = tile_edges(size, tile)
        self.tiles: list[list[NDArray[np.float64]]] = []

    def add_column(self) -> None:
        """Make the next block of columns, zeros."""
        widths = np.diff(self.edges).tolist()
        column = len(self.tiles)
        self.tiles.append(
            [zeros_apart((height, widths[column])) for height in widths[: column + 1]]
        )

    def give_up(self, column: int) -> None:
        """Free the tiles of a block of columns."""
        self.tiles[column] = []

    @property
    def size(self) -> int:
        """Numbers held by the tiles."""
        return sum(tile.size for column in self.tiles for tile in column)

    def subtract_gram(self, panel: NDArray[np.float64], done: Callable[[float], None]) -> None:
        """Subtract ``panel.T @ panel``; panel is (k, m) and Fortran-ordered.

        ``done`` is called with the floating point operations of each call when it ends.
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
        """Full matrix, (m, m), both halves."""
        upper = np.zeros((self.edges[-1],) * 2)
        for column, stack in enumerate(self.tiles):
            columns = slice(*self.edges[column : column + 2])
            for row, tile in enumerate(stack):
                upper[slice(*self.edges[row : row + 2]), columns] = tile
        upper = np.triu(upper)
        return upper + np.triu(upper, 1).T


def tile_edges(size: int, tile: int = TILE) -> tuple[int, ...]:
    """Starts of blocks of at most ``tile`` along ``size`` rows, and ``size`` itself."""
    return (*range(0, size, tile), size)
