"""Compression of clusters by the workers of any ``concurrent.futures`` executor.

The factor has hundreds of megabytes at twenty thousand nodes, so it is not sent with every cluster
but written to a folder once; workers memory-map it, and those of one machine share the pages. Only
cluster numbers and reduced columns, about a megabyte each, are sent.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...machine.blas_threads import blas_threads
from ..elimination.numeric import LoadRows
from ..elimination.surface_columns import SurfaceColumns
from .cluster_columns import ClusterColumns, ClusterTask
from .compress import MapClusters

INDEX_FILE = "index.npz"


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
        return _opened(self.folder).free_surface

    @property
    def node_count(self) -> int:
        """Number of free surface nodes, n."""
        return _opened(self.folder).node_count

    def columns(self, nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        """The columns of L for forces on ``nodes`` (k,), as a matrix (3n, 3k)."""
        return _opened(self.folder).columns(nodes)

    def diagonal(self) -> NDArray[np.float64]:
        """All blocks L_ii, (n, 3, 3)."""
        return _opened(self.folder).diagonal()


def store(columns: SurfaceColumns, folder: Path) -> StoredColumns:
    """Write the factor into ``folder``, one array a file so that each can be mapped."""
    np.savez(
        folder / INDEX_FILE,
        allow_pickle=False,
        free_surface=columns.free_surface,
        ranks=columns.ranks,
        spans=np.array([(part.start, part.stop) for part in columns.factor]),
    )
    for number, part in enumerate(columns.factor):
        np.save(_rows_file(folder, number), part.rows, allow_pickle=False)
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
        # Windows keeps what a worker still maps; the folder's owner deletes it in the end.
        shutil.rmtree(place, ignore_errors=True)


@dataclass(frozen=True)
class _OnWorker:
    """Reduction of a cluster with the worker's number of BLAS threads."""

    task: ClusterTask
    threads: int

    def __call__(self, cluster: int) -> ClusterColumns:
        with blas_threads(self.threads):
            return self.task(cluster)


# Only the latest body stays open in a worker.
@lru_cache(maxsize=1)
def _opened(folder: Path) -> SurfaceColumns:
    with np.load(folder / INDEX_FILE, allow_pickle=False) as index:
        free_surface, ranks, spans = index["free_surface"], index["ranks"], index["spans"]
    factor = tuple(
        LoadRows(int(start), int(stop), np.load(_rows_file(folder, number), mmap_mode="r"))
        for number, (start, stop) in enumerate(spans)
    )
    return SurfaceColumns(free_surface, factor, ranks)


def _rows_file(folder: Path, number: int) -> Path:
    return folder / f"rows-{number}.npy"
