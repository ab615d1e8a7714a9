"""STL: triangles with places of their own, in bytes or in lines of text."""

from __future__ import annotations

from itertools import islice
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from .polygons import LINES_AT_ONCE, MeshFormatError, joined, lines_of, text_numbers

HEAD_BYTES = 84
COUNT_AT = 80
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("other", "<u2")])


def read_stl(stream: IO[bytes], size: int) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Vertices (V, 3), float32, and triangles (V / 3, 3) of a file of ``size`` bytes.

    Raises
    ------
    MeshFormatError
        Neither text nor as long as its count says; facets that have not three corners.
    """
    head = stream.read(HEAD_BYTES)
    count = int.from_bytes(head[COUNT_AT:], "little")
    # Binary files may begin with "solid" too; only the length is decisive.
    if size == HEAD_BYTES + TRIANGLE.itemsize * count and len(head) == HEAD_BYTES:
        facets = np.frombuffer(stream.read(), dtype=TRIANGLE)
        return _triangles(facets["corners"].reshape(-1, 3).astype(np.float32))
    if not head.lstrip().lower().startswith(b"solid"):
        raise MeshFormatError(
            f"neither text nor as long as its binary header says: {count:,} triangles would take "
            f"{HEAD_BYTES + TRIANGLE.itemsize * count:,} bytes, and it has {size:,}"
        )
    stream.seek(0)
    return _triangles(_text_corners(stream))


def _text_corners(stream: IO[bytes]) -> NDArray[np.float32]:
    parts: list[NDArray[np.float64]] = []
    facets = corners = 0
    lines = (line.strip().lower() for line in lines_of(stream))
    while some := list(islice(lines, LINES_AT_ONCE)):
        facets += sum(line.startswith(b"facet") for line in some)
        vertices = [line for line in some if line.startswith(b"vertex")]
        corners += len(vertices)
        parts.append(text_numbers(vertices, (1, 2, 3), "a line 'vertex'"))
    if corners != 3 * facets:
        raise MeshFormatError(
            f"neither text nor as long as its binary header says: as text, {facets:,} facets have "
            f"{corners:,} corners"
        )
    with np.errstate(over="ignore"):
        return joined(parts, 3).astype(np.float32)


def _triangles(corners: NDArray[np.float32]) -> tuple[NDArray[Any], NDArray[np.int64]]:
    return corners, np.arange(len(corners), dtype=np.int64).reshape(-1, 3)
