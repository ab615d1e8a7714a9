"""Polygons and numbers as mesh files hold them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

# Lines that are held as text at a time: a line takes many times its length of memory.
LINES_AT_ONCE = 20_000
# A million corners of one polygon.
LONGEST_LINE = 10_000_000


class MeshFormatError(Exception):
    """Contents that are no mesh; the message is the reason."""


def lines_of(stream: IO[bytes]) -> Iterator[bytes]:
    """Lines of a file, read one by one.

    Raises
    ------
    MeshFormatError
        One is longer than any of a mesh, as where the file is no text.
    """
    while line := stream.readline(LONGEST_LINE):
        if len(line) == LONGEST_LINE:
            raise MeshFormatError(f"it has a line of more than {LONGEST_LINE:,} letters")
        yield line


def triangulated(corners: NDArray[np.int64], sizes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles (t, 3) of polygons, each as a fan about its first corner.

    >>> triangulated(np.array([4, 5, 6, 7, 0, 1, 2]), np.array([4, 3])).tolist()
    [[4, 5, 6], [4, 6, 7], [0, 1, 2]]

    Parameters
    ----------
    corners : of all polygons, one after the other.
    sizes : corners of each polygon; those of fewer than three are left out.
    """
    starts = np.cumsum(sizes) - sizes
    counts = np.maximum(sizes - 2, 0)
    first = np.repeat(starts, counts)
    step = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    fans = np.column_stack([first, first + step + 1, first + step + 2])
    triangles: NDArray[np.int64] = corners[fans]
    return triangles


def text_numbers(lines: Sequence[bytes], columns: Sequence[int], what: str) -> NDArray[np.float64]:
    """Numbers (lines, columns) of lines of words, where ``columns`` name the words.

    Raises
    ------
    MeshFormatError
        ``what`` has other words there, or too few.
    """
    if not lines:
        return np.empty((0, len(columns)))
    text = [line.decode("latin-1") for line in lines]
    try:
        return np.loadtxt(text, usecols=tuple(columns), comments=None, ndmin=2)
    except (ValueError, IndexError, OverflowError) as problem:
        raise MeshFormatError(f"{what} has no {len(columns)} numbers: {problem}") from problem


def joined(parts: Sequence[NDArray[Any]], columns: int) -> NDArray[Any]:
    """Arrays (n, columns) in one; integers (0, columns) where there are none."""
    return np.concatenate(parts) if parts else np.empty((0, columns), dtype=np.int64)
