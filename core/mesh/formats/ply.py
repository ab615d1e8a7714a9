"""PLY: vertices and faces, in bytes or in lines of text; other elements are left out."""

from __future__ import annotations

from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from .ply_header import Element, read_header
from .ply_rows import BinaryRows, TextRows
from .polygons import MeshFormatError, triangulated

AXES = ("x", "y", "z")
CORNERS = ("vertex_indices", "vertex_index")


def read_ply(stream: IO[bytes], size: int) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Vertices (V, 3), in their own precision, and triangles (F, 3) of a file of ``size`` bytes.

    Raises
    ------
    MeshFormatError
        No PLY, without ``x``, ``y``, ``z``, longer or shorter than its header says.
    """
    header = read_header(stream, size)
    rows: TextRows | BinaryRows = TextRows(stream)
    if header.byte_order:
        rows = BinaryRows(stream.read(), header.byte_order)
    vertices: NDArray[Any] = np.empty((0, 3))
    triangles = np.empty((0, 3), dtype=np.int64)
    for element in header.elements:
        if element.name == "vertex":
            vertices = rows.numbers(element, _places(element))
        elif element.name == "face":
            corners = _corners(element)
            sizes, numbers = rows.lists(element, corners)
            triangles = triangulated(numbers, sizes)
        else:
            rows.skip(element)
    return vertices, triangles


def _places(element: Element) -> list[int]:
    names = [entry.name for entry in element.properties]
    if element.has_lists or not set(AXES) <= set(names):
        raise MeshFormatError("its vertices are not described by numbers x, y, z")
    return [names.index(axis) for axis in AXES]


def _corners(element: Element) -> int:
    """Number of the property that holds the corners of faces."""
    lists = [place for place, entry in enumerate(element.properties) if entry.counts]
    named = [place for place in lists if element.properties[place].name in CORNERS]
    if not lists:
        raise MeshFormatError("its faces have no list of vertices")
    place = (named or lists)[0]
    if element.properties[place].kind.startswith("f"):
        raise MeshFormatError("its faces name vertices by numbers that are not whole")
    return place
