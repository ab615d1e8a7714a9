"""Rows of a PLY file's elements, in text or in bytes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from .ply_header import Element, Property
from .polygons import LINES_AT_ONCE, MeshFormatError, joined, lines_of, text_numbers

# Sizes of lists, and what they hold one after the other.
Lists = tuple[NDArray[np.int64], NDArray[np.int64]]


class TextRows:
    """Rows as lines of text, taken one element after the other."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._lines = (line for line in lines_of(stream) if not line.isspace())

    def numbers(self, element: Element, columns: list[int]) -> NDArray[Any]:
        """Properties ``columns`` (count, columns) of an element without lists."""
        parts = [text_numbers(some, columns, "a vertex") for some in self._parts(element)]
        kind = np.result_type(*(element.properties[column].kind for column in columns))
        with np.errstate(over="ignore", invalid="ignore"):
            return joined(parts, len(columns)).astype(kind)

    def lists(self, element: Element, column: int) -> Lists:
        """Property ``column``, a list, of all rows."""
        sizes: list[int] = []
        found: list[int] = []
        try:
            for words in (line.split() for some in self._parts(element) for line in some):
                values = _listed(words, element.properties, column)
                sizes.append(len(values))
                found.extend(map(int, values))
            return np.array(sizes, dtype=np.int64), np.array(found, dtype=np.int64)
        except (ValueError, OverflowError) as problem:
            raise MeshFormatError(f"a face is not as the header says: {problem}") from problem

    def skip(self, element: Element) -> None:
        """Leave an element out."""
        for _ in self._parts(element):
            pass

    def _parts(self, element: Element) -> Iterator[list[bytes]]:
        """Lines of the element's rows, some at a time."""
        left = element.count
        while left:
            some = list(islice(self._lines, min(left, LINES_AT_ONCE)))
            if not some:
                raise MeshFormatError(f"the last {left:,} '{element.name[:30]}' are missing")
            left -= len(some)
            yield some


class BinaryRows:
    """Rows as bytes, taken one element after the other."""

    def __init__(self, content: bytes, byte_order: str) -> None:
        self._content = content
        self._order = byte_order
        self._at = 0

    def numbers(self, element: Element, columns: list[int]) -> NDArray[Any]:
        """Properties ``columns`` (count, columns) of an element without lists."""
        kinds = [self._order + entry.kind for entry in element.properties]
        rows = self._taken(
            np.dtype({"names": [*map(str, range(len(kinds)))], "formats": kinds}), element
        )
        return np.column_stack([rows[str(column)] for column in columns])

    def lists(self, element: Element, column: int) -> Lists:
        """Property ``column``, a list, of all rows."""
        alike = self._lists_alike(element, column)
        return self._lists_one_by_one(element, column) if alike is None else alike

    def skip(self, element: Element) -> None:
        """Leave an element out."""
        if element.has_lists:
            self._lists_one_by_one(element, -1)
        else:
            self._at += element.count * sum(entry.least_bytes for entry in element.properties)

    def _taken(self, row: np.dtype[Any], element: Element) -> NDArray[Any]:
        end = self._at + row.itemsize * element.count
        if end > len(self._content):
            raise MeshFormatError(f"the last '{element.name[:30]}' are missing")
        rows = np.frombuffer(self._content, row, element.count, self._at)
        self._at = end
        return rows

    def _lists_alike(self, element: Element, column: int) -> Lists | None:
        """The lists, if they are the rows' only ones and as long as that of the first row."""
        lists = [entry for entry in element.properties if entry.counts]
        before = sum(entry.least_bytes for entry in element.properties[:column])
        if len(lists) != 1 or not element.count:
            return None
        length = self._number(self._at + before, lists[0].counts)
        each = sum(entry.least_bytes for entry in element.properties)
        each += length * int(lists[0].kind[1:])
        if length < 1 or self._at + each * element.count > len(self._content):
            return None
        formats: list[Any] = []
        for entry in element.properties:
            kind = self._order + entry.kind
            formats += [self._order + entry.counts, (kind, (length,))] if entry.counts else [kind]
        row = np.dtype({"names": [*map(str, range(len(formats)))], "formats": formats})
        rows = np.frombuffer(self._content, row, element.count, self._at)
        if (rows[str(column)] != length).any():
            return None
        self._at += each * element.count
        values = rows[str(column + 1)].astype(np.int64).ravel()
        return np.full(element.count, length, dtype=np.int64), values

    def _lists_one_by_one(self, element: Element, column: int) -> Lists:
        sizes: list[int] = []
        found = bytearray()
        at, content = self._at, self._content
        for _ in range(element.count):
            for place, entry in enumerate(element.properties):
                if not entry.counts:
                    at += entry.least_bytes
                    continue
                length = self._number(at, entry.counts)
                start = at + entry.least_bytes
                at = start + length * int(entry.kind[1:])
                if length < 0 or at > len(content):
                    raise MeshFormatError(
                        f"a list of '{element.name[:30]}' is longer than the file"
                    )
                if place == column:
                    sizes.append(length)
                    found += content[start:at]
        self._at = at
        kind = self._order + (element.properties[column].kind if column >= 0 else "u1")
        return np.array(sizes, dtype=np.int64), np.frombuffer(found, kind).astype(np.int64)

    def _number(self, at: int, kind: str) -> int:
        word = self._content[at : at + int(kind[1:])]
        return int.from_bytes(
            word, "little" if self._order == "<" else "big", signed=kind.startswith("i")
        )


def _listed(words: list[bytes], properties: list[Property], column: int) -> list[bytes]:
    """Words of the list ``column`` in a row's words."""
    at = 0
    found: list[bytes] = []
    for place, entry in enumerate(properties):
        length = int(words[at]) if entry.counts and at < len(words) else 0
        start, at = at + bool(entry.counts), at + 1 + length
        if length < 0 or at > len(words):
            raise ValueError(f"it has {len(words)} words")
        if place == column:
            found = words[start:at]
    return found
