"""Point cache: the places of a mesh's vertices in every frame, as a PC2 file.

PC2 is little-endian: ``POINTCACHE2``, a version, the number of points, the first frame, frames a
sample, the number of samples, then float32 x, y, z of all points of each sample. What follows them
is read by nobody; there Palpate writes a word, by which it knows its own files again.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from .atomic_file import atomic_file
from .own_file import is_ordinary
from .windows.shared_reading import open_shared

MAGIC = b"POINTCACHE2\0"
VERSION = 1
HEADER = struct.Struct("<12siiffi")
TRAILER = b"palpate animation\0"


@dataclass(frozen=True)
class CacheSize:
    """Extent of a cache.

    Attributes
    ----------
    points, samples : numbers of vertices and of frames that are stored.
    first_frame : scene frame of the first sample.
    step : scene frames from one sample to the next.
    """

    points: int
    samples: int
    first_frame: float = 1.0
    step: float = 1.0


@dataclass(eq=False)
class CacheWriter:
    """Cache that is being written; :func:`point_cache` makes it."""

    size: CacheSize
    _file: IO[bytes]
    written: int = 0

    def write(self, coordinates: NDArray[np.float32]) -> None:
        """Write the next sample, flat float32 (3 p,).

        Raises
        ------
        ValueError
            Another number of coordinates, or one sample too many.
        """
        if coordinates.shape != (3 * self.size.points,) or self.written == self.size.samples:
            message = f"sample {self.written} of {coordinates.shape} does not fit {self.size}"
            raise ValueError(message)
        self._file.write(coordinates.astype("<f4", copy=False).tobytes())
        self.written += 1


@contextmanager
def point_cache(target: Path, size: CacheSize) -> Iterator[CacheWriter]:
    """New cache that takes its place once all its samples are written, and none is left otherwise.

    Raises
    ------
    UnwritableError
        As for :func:`.atomic_file.atomic_file`.
    ValueError
        Samples are missing at the end.
    """
    with atomic_file(target, make_folders=True, follows_links=False) as file:
        header = (MAGIC, VERSION, size.points, size.first_frame, size.step, size.samples)
        file.write(HEADER.pack(*header))
        writer = CacheWriter(size, file)
        yield writer
        if writer.written != size.samples:
            message = f"{writer.written} samples of {size.samples} were written"
            raise ValueError(message)
        file.write(TRAILER)


def is_own_cache(path: Path) -> bool:
    """Whether an ordinary file is a cache that Palpate wrote."""
    if not is_ordinary(path):
        return False
    with open_shared(path) as file:
        begins = file.read(len(MAGIC)) == MAGIC
        file.seek(0, 2)
        file.seek(max(0, file.tell() - len(TRAILER)))
        return begins and file.read() == TRAILER
