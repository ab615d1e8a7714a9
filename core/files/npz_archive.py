"""``.npz`` archives: untrusted ones read safely, and ones written so that they can be mapped.

numpy writes members uncompressed but unaligned. Here each array begins at a multiple of 64 bytes,
so that a large one can be memory-mapped instead of read. ``numpy.load`` reads both kinds.
"""

from __future__ import annotations

import mmap
import os
import struct
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from ..errors import PalpateError
from .npz_members import MOST_HEAD_BYTES, MembersError, array_head, head_of, listed
from .windows.shared_reading import open_shared

# Alignment to which numpy pads the header of an array.
ALIGNMENT = 64
# Extra field that zip readers know as padding (from Android's zipalign).
PADDING_FIELD = 0xD935
FIELD_HEADER = struct.Struct("<HH")
# Local file header; name and extra field follow it.
LOCAL_HEADER = struct.Struct("<4s22xHH")
ZIP64_FIELD_BYTES = 20
LOCAL_MAGIC = b"PK\x03\x04"


class ArchiveError(PalpateError):
    """Unreadable archive. The message names file and reason; callers add the remedy."""


@dataclass(frozen=True, eq=False)
class MappedArray:
    """Memory-mapped array.

    Attributes
    ----------
    array : read only.
    """

    array: NDArray[Any]
    _mapping: mmap.mmap
    _end: int

    @property
    def is_complete(self) -> bool:
        """Whether the file still reaches to the array's end.

        Reading beyond the end of a truncated file would kill the process (SIGBUS).
        """
        return self._mapping.size() >= self._end


class Archive:
    """Open archive, its list and the heads of its arrays checked; made by :func:`opened`.

    Attributes
    ----------
    heads : shape and type of each array, by name; nothing of the arrays has been read.
    """

    def __init__(self, stream: IO[bytes], path: Path) -> None:
        self._stream = stream
        self._path = path
        self._zip = listed(stream)
        names = [name[:-4] for name in self._zip.namelist() if name.endswith(".npy")]
        self.heads = {name: array_head(self._zip, f"{name}.npy") for name in names}

    @property
    def names(self) -> list[str]:
        """Names of the arrays."""
        return list(self.heads)

    def read(self, name: str) -> NDArray[Any]:
        """The array, copied into memory; pickled objects are refused."""
        with self._zip.open(f"{name}.npy") as member:
            array: NDArray[Any] = npy.read_array(member, allow_pickle=False)
        return array

    def map(self, name: str) -> MappedArray:
        """The array, memory-mapped; the file may be closed and replaced afterwards.

        Raises
        ------
        ArchiveError
            The member is compressed, or not as long as its array.
        """
        member = self._zip.getinfo(f"{name}.npy")
        self._stream.seek(member.header_offset)
        magic, name_bytes, extra_bytes = LOCAL_HEADER.unpack(self._stream.read(LOCAL_HEADER.size))
        start = member.header_offset + LOCAL_HEADER.size + name_bytes + extra_bytes
        self._stream.seek(start)
        version = npy.read_magic(self._stream)
        read_header = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, is_fortran, dtype = read_header(self._stream)
        first, end = self._stream.tell(), start + member.file_size
        count = int(np.prod(shape, dtype=np.int64))
        if (
            magic != LOCAL_MAGIC
            or member.compress_type != zipfile.ZIP_STORED
            or is_fortran
            or dtype.hasobject
            or first + count * dtype.itemsize != end
            or end > self._zip.start_dir
        ):
            raise ArchiveError(
                "{path}: damaged ('{name}' does not lie where it should)",
                path=self._path,
                name=name,
            )
        mapping = _mapped(self._stream)
        array = np.frombuffer(mapping, dtype, count, first).reshape(shape)
        return MappedArray(array, mapping, end)


def _mapped(stream: IO[bytes]) -> mmap.mmap:
    """The whole file, mapped; on Windows that would leave the stream's descriptor at its start."""
    descriptor = stream.fileno()
    place = os.lseek(descriptor, 0, os.SEEK_CUR)
    mapping = mmap.mmap(descriptor, 0, access=mmap.ACCESS_READ)
    os.lseek(descriptor, place, os.SEEK_SET)
    return mapping


@contextmanager
def opened(path: Path) -> Iterator[Archive]:
    """The archive at ``path``, open while the block runs.

    Raises
    ------
    ArchiveError
        It cannot be opened, or is found damaged, truncated or no archive within the block.
    """
    try:
        stream = open_shared(path)
    except OSError as problem:
        raise ArchiveError(
            "{path}: cannot be opened ({reason})", path=path, reason=problem.strerror
        ) from problem
    with stream:
        try:
            yield Archive(stream, path)
        except PalpateError:
            raise
        except MembersError as problem:
            raise ArchiveError(
                "{path}: refused before it was read ({reason})", path=path, reason=str(problem)
            ) from problem
        except Exception as problem:  # zip, its packers and numpy's headers: each fails its own way
            raise ArchiveError(
                "{path}: damaged, cut short or not an npz archive ({problem})",
                path=path,
                problem=repr(problem),
            ) from problem


def read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    """All arrays of the archive at ``path`` by name; members that are no arrays are left out.

    Raises
    ------
    ArchiveError
        It cannot be opened, or is damaged, truncated or no archive.
    """
    with opened(path) as archive:
        return {name: archive.read(name) for name in archive.names}


def read_array(path: Path) -> NDArray[Any]:
    """The only array of a ``.npy`` file.

    Raises
    ------
    ArchiveError
        It cannot be opened, is no array, one of objects, or not as long as its shape.
    """
    try:
        with open_shared(path) as stream:
            head_of(stream.read(MOST_HEAD_BYTES), os.fstat(stream.fileno()).st_size, "it")
            stream.seek(0)
            array: NDArray[Any] = npy.read_array(stream, allow_pickle=False)
    except (OSError, MembersError, ValueError) as problem:
        raise ArchiveError(
            "{path}: cannot be read as npy ({reason})", path=path, reason=str(problem)
        ) from problem
    return array


def write_arrays(stream: IO[bytes], arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write an archive of ``arrays`` that :meth:`Archive.map` can use in place.

    The same arrays always give the same bytes. ``stream`` must be new and able to seek.
    """
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive:
        for name, array in arrays.items():
            member = zipfile.ZipInfo(f"{name}.npy")
            # 64-bit sizes throughout, so that the header's length is known in advance.
            header = LOCAL_HEADER.size + len(member.filename.encode()) + ZIP64_FIELD_BYTES
            start = stream.tell() + header + FIELD_HEADER.size
            padding = -start % ALIGNMENT
            member.extra = FIELD_HEADER.pack(PADDING_FIELD, padding) + bytes(padding)
            with archive.open(member, "w", force_zip64=True) as file:
                npy.write_array(file, np.asanyarray(array), allow_pickle=False)
