"""Header of a PLY file: its elements, held against the file's length before anything is read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import IO

from .polygons import MeshFormatError

MOST_HEADER_BYTES = 64_000
MOST_PROPERTIES = 200
BYTE_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
NAMES = {
    "i1": "char int8",
    "u1": "uchar uint8",
    "i2": "short int16",
    "u2": "ushort uint16",
    "i4": "int int32",
    "u4": "uint uint32",
    "f4": "float float32",
    "f8": "double float64",
}
TYPES = {name: kind for kind, names in NAMES.items() for name in names.split()}
COUNT = re.compile(r"\d{1,15}")


@dataclass(frozen=True)
class Property:
    """Property of an element; ``counts`` is the type of a list's length, empty for a number."""

    name: str
    kind: str
    counts: str = ""

    @property
    def least_bytes(self) -> int:
        """Bytes of it in a binary row at least."""
        return int((self.counts or self.kind)[1:])


@dataclass(frozen=True)
class Element:
    """Element: ``count`` rows of its properties."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)

    @property
    def has_lists(self) -> bool:
        """Whether its rows may differ in length."""
        return any(entry.counts for entry in self.properties)


@dataclass(frozen=True)
class PlyHeader:
    """Header of a PLY file.

    Attributes
    ----------
    byte_order : ``<`` or ``>``; empty for text.
    elements : in the file's order.
    """

    byte_order: str
    elements: list[Element]


def read_header(stream: IO[bytes], size: int) -> PlyHeader:
    """The header; ``stream``, of ``size`` bytes, is left behind it.

    Raises
    ------
    MeshFormatError
        No PLY, an unknown type, more rows than the file could hold.
    """
    lines = _header_lines(stream)
    if next(lines, None) != ["ply"]:
        raise MeshFormatError("its first line is not 'ply'")
    byte_order: str | None = None
    elements: list[Element] = []
    for words in lines:
        match words:
            case [] | ["comment" | "obj_info", *_]:
                continue
            case ["format", kind, "1.0"] if kind in BYTE_ORDERS:
                byte_order = BYTE_ORDERS[kind]
            case ["element", name, count] if COUNT.fullmatch(count):
                elements.append(Element(name, int(count)))
            case ["property", "list", counts, kind, name] if elements and TYPES.get(
                counts, "f"
            ).startswith(("i", "u")):
                _add(elements, Property(name, _type(kind), TYPES[counts]))
            case ["property", kind, name] if elements:
                _add(elements, Property(name, _type(kind)))
            case _:
                raise MeshFormatError(f"its header has the line '{' '.join(words)[:60]}'")
    if byte_order is None:
        raise MeshFormatError("its header names no format")
    header = PlyHeader(byte_order, elements)
    _refuse_promises(header, size - stream.tell())
    return header


def _header_lines(stream: IO[bytes]) -> Iterator[list[str]]:
    """Words of each line before ``end_header``."""
    left = MOST_HEADER_BYTES
    while left > 0:
        line = stream.readline(left)
        left -= len(line)
        words = line.decode("latin-1").split()
        if words == ["end_header"]:
            return
        if not line:
            break
        yield words
    raise MeshFormatError(f"its header does not end within {MOST_HEADER_BYTES:,} bytes")


def _type(kind: str) -> str:
    if kind not in TYPES:
        raise MeshFormatError(f"its header names the type '{kind[:30]}'")
    return TYPES[kind]


def _add(elements: list[Element], entry: Property) -> None:
    known = elements[-1].properties
    if len(known) >= MOST_PROPERTIES or any(entry.name == other.name for other in known):
        raise MeshFormatError(f"its header names '{entry.name[:30]}' twice, or too many properties")
    known.append(entry)


def _refuse_promises(header: PlyHeader, left: int) -> None:
    """Hold the promised rows against the ``left`` bytes behind the header."""
    for element in header.elements:
        if element.count and not element.properties:
            raise MeshFormatError(f"its {element.count:,} '{element.name[:30]}' have no properties")
        each = sum(entry.least_bytes for entry in element.properties)
        if not header.byte_order:
            # A digit and a blank or the line's end each; the last line may do without.
            each = 2 * len(element.properties)
        needed = each * element.count - (0 if header.byte_order else 1)
        if needed > left:
            raise MeshFormatError(
                f"its header promises {element.count:,} '{element.name[:30]}', which take at "
                f"least {needed:,} bytes, and {max(0, left):,} follow"
            )
        left -= max(0, needed)
