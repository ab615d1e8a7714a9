"""Memory that can still be had without swapping, and arrays that give theirs back at once."""

from __future__ import annotations

import mmap
import sys
from dataclasses import dataclass
from math import prod
from pathlib import Path

import numpy as np
import psutil
from numpy.typing import NDArray

# Arrays of more bytes have memory of their own. As many the system clears at once, where it may.
APART_ABOVE = 1_000_000
CLEARED_AT_ONCE = 2**21


@dataclass(frozen=True)
class ControlGroup:
    """Files in which Linux states a container's limit and use of memory.

    ``reclaimable`` names the line of ``statistics`` with the inactive page cache: it counts as
    used, but is freed under memory pressure.
    """

    limit: str
    use: str
    statistics: str
    reclaimable: str

    def bytes_left(self, root: Path) -> int | None:
        """Bytes below the limit; None where there is no such group or no limit."""
        if not all((root / name).is_file() for name in (self.limit, self.use, self.statistics)):
            return None
        limit = (root / self.limit).read_text(encoding="ascii").strip()
        if not limit.isdigit():
            return None
        lines = (root / self.statistics).read_text(encoding="ascii").splitlines()
        counts = dict(line.split(maxsplit=1) for line in lines)
        use = int((root / self.use).read_text(encoding="ascii"))
        return max(0, int(limit) - use + int(counts.get(self.reclaimable, 0)))


CONTROL_GROUPS = (
    ControlGroup("memory.max", "memory.current", "memory.stat", "inactive_file"),
    ControlGroup(
        "memory/memory.limit_in_bytes",
        "memory/memory.usage_in_bytes",
        "memory/memory.stat",
        "total_inactive_file",
    ),
)


def available_memory(groups_root: Path = Path("/sys/fs/cgroup")) -> int:
    """Bytes available: as the system says, or fewer within a container."""
    left = (group.bytes_left(groups_root) for group in CONTROL_GROUPS)
    system = int(psutil.virtual_memory().available)
    return min([system, *(count for count in left if count is not None)])


def zeros_apart(shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Zeros of that shape in Fortran order, whose memory goes back to the system with the array.

    glibc keeps what is freed, once arrays of up to 32 MB have come and gone, in holes between what
    is in use; other systems give large pieces back by themselves. Pages that nothing is written to
    take no memory.
    """
    count = 8 * prod(shape)
    if sys.platform != "linux" or count <= APART_ABOVE:
        return np.zeros(shape, order="F")
    memory = mmap.mmap(-1, count, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    if count >= CLEARED_AT_ONCE and hasattr(mmap, "MADV_HUGEPAGE"):
        memory.madvise(mmap.MADV_HUGEPAGE)
    return np.frombuffer(memory).reshape(shape, order="F")
