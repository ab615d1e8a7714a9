"""Compression of clusters by the workers of any ``concurrent.futures`` executor.

The factor has hundreds of megabytes at twenty thousand nodes, so it is not sent with every cluster
but written to a folder once; workers memory-map it, and those of one machine share the pages. Only
cluster numbers and reduced columns, about a megabyte each, are sent.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...files.windows.patience import remove_folder
from ...machine.blas_threads import blas_threads
from ..elimination.numeric import LoadRows
from ..elimination.surface_columns import SurfaceColumns
from ..free_body.rigid_part import RigidPart
from .cluster_columns import ClusterColumns, ClusterTask
from .compress import MapClusters

INDEX_FILE = "index.npz"
ROWS_FILE = "rows.npy"


@dataclass(frozen=True)
class StoredColumns:
    """Column source in a folder, cheap to pickle.

    Attributes
    ----------
    folder : where :func:`store` put it; the same path for all workers.
    """

    folder: Path

    @property
    def free_surface(self) -> NDArray[np.int64]:
        """Node numbers (n,) of the body's free surface, ascending."""
        return self._opened().free_surface

    @property
    def node_count(self) -> int:
        """Number of free surface nodes, n."""
        return self._opened().node_count

    def columns(self, nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        """The columns of L for forces on ``nodes`` (k,), as a matrix (3n, 3k)."""
        return self._opened().columns(nodes)

    def diagonal(self) -> NDArray[np.float64]:
        """All blocks L_ii, (n, 3, 3)."""
        return self._opened().diagonal()

    def _opened(self) -> SurfaceColumns:
        """The source, its factor mapped while it is referred to: then the folder can be removed."""
        with np.load(self.folder / INDEX_FILE, allow_pickle=False) as index:
            free_surface, ranks, parts = index["free_surface"], index["ranks"], index["parts"]
            rigid = RigidPart(index["modes"], index["response"]) if "modes" in index else None
        rows = np.load(self.folder / ROWS_FILE, mmap_mode="r")
        ends = np.cumsum((parts[:, 1] - parts[:, 0]) * parts[:, 2])
        factor = tuple(
            LoadRows(int(start), int(stop), piece.reshape((int(count), -1), order="F"))
            for (start, stop, count), piece in zip(parts, np.split(rows, ends[:-1]), strict=True)
        )
        return SurfaceColumns(free_surface, factor, ranks, rigid)


def store(columns: SurfaceColumns, folder: Path) -> StoredColumns:
    """Write the factor into ``folder``, as one array that is mapped in a moment."""
    rigid = {}
    if columns.rigid is not None:
        rigid = {"modes": columns.rigid.modes, "response": columns.rigid.response}
    parts = [(part.start, part.stop, len(part.rows)) for part in columns.factor]
    np.savez(
        folder / INDEX_FILE,
        allow_pickle=False,
        free_surface=columns.free_surface,
        ranks=columns.ranks,
        parts=np.array(parts, dtype=np.int64),
        **rigid,
    )
    count = sum(part.rows.size for part in columns.factor)
    rows = np.lib.format.open_memmap(folder / ROWS_FILE, "w+", np.float64, (count,))
    end = 0
    for part in columns.factor:
        begin, end = end, end + part.rows.size
        rows[begin:end] = part.rows.ravel(order="F")
    return StoredColumns(folder)


@contextmanager
def clusters_on(
    executor: Executor, columns: SurfaceColumns, folder: Path, threads: int = 1
) -> Iterator[MapClusters]:
    """``map_clusters`` of :func:`palpate.core.compliance.compression.compress.compress`.

    Parameters
    ----------
    executor : of processes; threads would wait for each other, since scipy's BLAS holds the GIL.
    columns : the source that is compressed.
    folder : where workers reach it; it takes ``columns.nbytes`` while the work lasts.
    threads : of BLAS in each worker.
    """
    place = Path(tempfile.mkdtemp(prefix="palpate-columns-", dir=folder))
    try:
        stored = store(columns, place)

        def map_clusters(task: ClusterTask, clusters: Iterable[int]) -> Iterable[ClusterColumns]:
            return executor.map(_OnWorker(replace(task, source=stored), threads), clusters)

        yield map_clusters
    finally:
        # A task still under way ends within seconds; until then Windows keeps what it maps.
        remove_folder(place)


@dataclass(frozen=True)
class _OnWorker:
    """Reduction of a cluster with the worker's number of BLAS threads."""

    task: ClusterTask
    threads: int

    def __call__(self, cluster: int) -> ClusterColumns:
        with blas_threads(self.threads):
            return self.task(cluster)
