"""Whether compressing by several processes pays, on one machine.

    python benchmarks/bake/clusters_on_workers.py [--quick]

Compresses ``mouse-20k`` (``mouse-1.7k`` with --quick) in this process with one thread of BLAS and
with all, then by one worker process and by as many as there are cores, one thread each. Workers are
started beforehand.
"""

from __future__ import annotations

import argparse
import multiprocessing
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.bodies import stored_body
from palpate.benchmarks.measuring.timing import seconds_of
from palpate.core.compliance.compression.clusters_on_workers import clusters_on
from palpate.core.compliance.compression.compress import compress
from palpate.core.compliance.elimination.surface_columns import SurfaceColumns, factor_for_columns
from palpate.core.machine.available_cores import available_cores
from palpate.core.machine.blas_threads import blas_threads
from palpate.core.stiffness.assembly import assemble

TOLERANCE = 1e-3


def by_processes(columns: SurfaceColumns, positions: NDArray[np.float64], count: int) -> float:
    """Seconds of compressing by ``count`` worker processes that run already."""
    spawned = multiprocessing.get_context("spawn")
    with (
        ProcessPoolExecutor(count, mp_context=spawned) as processes,
        tempfile.TemporaryDirectory() as folder,
    ):
        list(processes.map(abs, range(4 * count)))

        def work() -> None:
            with clusters_on(processes, columns, Path(folder)) as map_clusters:
                compress(columns, positions, TOLERANCE, map_clusters=map_clusters)

        return seconds_of(work)


def main() -> None:
    """Print one line for each way."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="the small mouse")
    body = stored_body("mouse-1.7k" if parser.parse_args().quick else "mouse-20k")
    cores = available_cores()
    columns = factor_for_columns(body.mesh, assemble(body.mesh, 0.3), body.fixed)
    positions = body.mesh.nodes[columns.free_surface]
    print(f"{body.name}: {columns.node_count} free surface nodes, {columns.nbytes / 1e6:.0f} MB")
    for threads in sorted({1, cores}):
        with blas_threads(threads):
            seconds = seconds_of(lambda: compress(columns, positions, TOLERANCE))
        print(f"  this process, {threads} threads of BLAS   {seconds:7.2f} s")
    for count in sorted({1, cores}):
        with blas_threads(1):
            seconds = by_processes(columns, positions, count)
        print(f"  worker processes: {count}              {seconds:7.2f} s")


if __name__ == "__main__":
    main()
