"""OBJ: places (``v``) and polygons (``f``) in lines of text; all else is left out."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from .polygons import LINES_AT_ONCE, MeshFormatError, joined, lines_of, text_numbers, triangulated

# What stands behind the number of a corner's place: those of its texture and normal.
OTHER_NUMBERS = re.compile(rb"/\S*")
BYTE_ORDER_MARK = b"\xef\xbb\xbf"


def read_obj(stream: IO[bytes]) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Vertices (V, 3) and triangles (F, 3); their numbers are not held against each other.

    Raises
    ------
    MeshFormatError
        A place without three numbers, a corner that is no number or 0.
    """
    places: list[NDArray[np.float64]] = []
    faces: list[NDArray[np.int64]] = []
    known = 0
    lines = _whole_lines(stream)
    while some := list(islice(lines, LINES_AT_ONCE)):
        found = text_numbers([line for line in some if _is(line, b"v")], (1, 2, 3), "a line 'v'")
        faces.append(_polygons(some, known))
        known += len(found)
        places.append(found)
    return joined(places, 3), joined(faces, 3)


def _is(line: bytes, word: bytes) -> bool:
    return line.startswith(word) and line[1:2].isspace()


def _whole_lines(stream: IO[bytes]) -> Iterator[bytes]:
    """Lines without blanks about them; one that ends in a backslash goes on in the next."""
    begun = bytearray()
    for number, line in enumerate(lines_of(stream)):
        text = (line.removeprefix(BYTE_ORDER_MARK) if number == 0 else line).strip()
        if text.endswith(b"\\"):
            begun += text[:-1] + b" "
        elif begun:
            yield bytes(begun + text)
            begun.clear()
        else:
            yield text
    yield bytes(begun)


def _polygons(lines: list[bytes], known: int) -> NDArray[np.int64]:
    """Triangles of the lines ``f``, after ``known`` places."""
    corners: list[int] = []
    sizes: list[int] = []
    before: list[int] = []
    for line in lines:
        if _is(line, b"v"):
            known += 1
        elif _is(line, b"f"):
            words = OTHER_NUMBERS.sub(b"", line).split()[1:]
            try:
                corners.extend(map(int, words))
            except ValueError as problem:
                raise MeshFormatError(f"a face names {_shown(line)}, no vertices") from problem
            sizes.append(len(words))
            before.append(known)
    try:
        numbers = np.array(corners, dtype=np.int64)
    except OverflowError as problem:
        raise MeshFormatError("a face names a vertex of more than 18 digits") from problem
    if (numbers == 0).any():
        raise MeshFormatError("a face names vertex 0, but they are numbered from 1")
    # Negative numbers count back from the last place before the line.
    counts = np.array(sizes, dtype=np.int64)
    from_zero = np.where(numbers > 0, numbers - 1, numbers + np.repeat(before, counts))
    return triangulated(from_zero.astype(np.int64), counts)


def _shown(line: bytes) -> str:
    return repr(line[2:40].decode("latin-1"))
