"""What an ``.npz`` archive says that it holds: looked at, and refused, before any of it is read.

The list of members is bounded before it is parsed, their places and sizes are held against the
file's, and the header of each array against its member: so what is read later is no longer than
the headers say, and these are no longer than a file of this size may hold. A zip bomb is refused
after a few kilobytes.
"""

from __future__ import annotations

import io
import math
import os
import zipfile
from dataclasses import dataclass
from typing import IO, Any

import numpy as np
from numpy.lib import format as npy

# A body has at most 26 arrays.
MOST_MEMBERS = 64
# Bytes of the list of members, with the end of the archive, and of the head of one array.
MOST_LIST_BYTES = 200_000
MOST_HEAD_BYTES = 4_096
# Coordinates and node numbers compress some ten times, a bomb a thousand times. What is small may
# compress as well as it likes.
LARGEST_RATIO = 20
ALWAYS_ALLOWED_BYTES = 16_000_000
METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
ENCRYPTED = 0x1
# Kinds of numbers, and text; no objects, no structures. Texts are names, reports and digests.
KINDS_OF_NUMBERS = "biuf"
MOST_LETTERS = 100_000


class MembersError(Exception):
    """An archive that is no good; the message is the reason."""


@dataclass(frozen=True)
class ArrayHead:
    """Array that an archive says it holds.

    Attributes
    ----------
    shape, dtype : of the array.
    nbytes : of its numbers.
    """

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    nbytes: int


class CountedStream(io.RawIOBase):
    """Seekable file that hands out no more than ``left`` bytes in all."""

    def __init__(self, stream: IO[bytes], left: int) -> None:
        self._stream = stream
        self.left = left

    def readable(self) -> bool:
        """It is."""
        return True

    def seekable(self) -> bool:
        """It is."""
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """As of a file."""
        return self._stream.seek(offset, whence)

    def tell(self) -> int:
        """As of a file."""
        return self._stream.tell()

    def read(self, size: int | None = -1) -> bytes:
        """As of a file; MembersError where more is asked for than is left."""
        asked = -1 if size is None else size
        here = self._stream.tell()
        end = self._stream.seek(0, os.SEEK_END)
        self._stream.seek(here)
        count = end - here if asked < 0 else min(asked, max(0, end - here))
        if count > self.left:
            raise MembersError("its list of members is longer than that of any of Palpate's")
        self.left -= count
        return self._stream.read(count)


def listed(stream: IO[bytes]) -> zipfile.ZipFile:
    """The archive in ``stream``, of which only the list of members was read, and checked.

    Raises
    ------
    MembersError
        Members that are too many, named twice, packed in an unusual way, overlap or reach beyond
        the file, or would be far larger unpacked.
    """
    counted = CountedStream(stream, MOST_LIST_BYTES)
    archive = zipfile.ZipFile(counted)
    size = stream.seek(0, os.SEEK_END)
    members = sorted(archive.infolist(), key=lambda member: member.header_offset)
    if len(members) > MOST_MEMBERS:
        raise MembersError(f"it has {len(members)} members, more than {MOST_MEMBERS}")
    if len({member.filename for member in members}) < len(members):
        raise MembersError("two members have the same name")
    end = 0
    for member in members:
        if member.compress_type not in METHODS or member.flag_bits & ENCRYPTED:
            raise MembersError(f"{member.filename!r} is packed or encrypted in an unusual way")
        is_stored = member.compress_type == zipfile.ZIP_STORED
        if is_stored and member.file_size != member.compress_size:
            raise MembersError(f"{member.filename!r} contradicts itself in its size")
        if member.header_offset < end or member.compress_size < 0:
            raise MembersError(f"{member.filename!r} lies over another member")
        end = member.header_offset + member.compress_size
    if end > min(size, archive.start_dir):
        raise MembersError("a member reaches beyond the file")
    unpacked, allowed = sum(m.file_size for m in members), LARGEST_RATIO * size
    if unpacked > max(allowed, ALWAYS_ALLOWED_BYTES):
        raise MembersError(
            f"its {size:,} bytes would become {unpacked:,}, which no mesh or body does"
        )
    # From here on the sizes of members bound what is read.
    counted.left = 2 * size + MOST_MEMBERS * MOST_HEAD_BYTES
    return archive


def array_head(archive: zipfile.ZipFile, member: str) -> ArrayHead:
    """Shape and type of the array in a member, from its first bytes.

    Raises
    ------
    MembersError
        It is no array, one of objects or structures, or not as long as its member.
    """
    with archive.open(member) as stream:
        head = stream.read(MOST_HEAD_BYTES)
    return head_of(head, archive.getinfo(member).file_size, repr(member))


def head_of(head: bytes, size: int, what: str) -> ArrayHead:
    """Shape and type of an array in ``npy`` form of ``size`` bytes that begins with ``head``.

    Raises
    ------
    MembersError
        ``what`` is no array, one of objects or structures, or not as long as its shape.
    """
    try:
        start = io.BytesIO(head)
        version = npy.read_magic(start)
        read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, _, dtype = read(start, max_header_size=MOST_HEAD_BYTES)
    except (ValueError, SyntaxError, TypeError, RecursionError, MemoryError) as problem:
        raise MembersError(f"{what} is no array") from problem
    is_text = dtype.kind == "U" and dtype.itemsize <= 4 * MOST_LETTERS
    if not (dtype.kind in KINDS_OF_NUMBERS or is_text) or dtype.hasobject:
        raise MembersError(f"{what} holds {dtype.name}, neither numbers nor text")
    if any(type(count) is not int or count < 0 for count in shape):
        raise MembersError(f"{what} has the shape {shape}")
    nbytes = math.prod(shape) * dtype.itemsize
    if start.tell() + nbytes != size:
        raise MembersError(f"{what} is not as long as its shape")
    return ArrayHead(shape, dtype, nbytes)
