"""From exact columns of the compliance to its compressed form, in one pass."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...errors import PalpateError
from ...progress import Progress, unwatched
from .cluster_columns import ClusterColumns, ClusterTask, estimated_scale
from .clusters import cluster_nodes
from .column_source import ColumnSource
from .compressed_compliance import CompressedCompliance
from .coupling import Coupling
from .packing import packed
from .tiles import Rounding

# Calls the task for each cluster number and hands the results over in the same order, as map does.
MapClusters = Callable[[ClusterTask, Iterable[int]], Iterable[ClusterColumns]]

SMALLEST_TOLERANCE, LARGEST_TOLERANCE = 1e-6, 0.1

# Share of the tolerance that cutting bases may use. Rounding, whose error is cheaper to buy, gets
# the rest. The second is for a second pass, where a body is harder than the estimate.
CUT_SHARES = (0.3, 0.05)

# Near blocks of 16 bits err by about 1e-4 of a column; below this tolerance they are float32.
SMALLEST_FOR_16_BITS = 3e-4

# Where progress stands when the passes begin and end; more than one is rare.
PASS_PROGRESS = (0.0, 0.85, 0.95, 0.98)

# The search for the coarsest step: about where it ends as a rule (times the tolerance over the root
# of the number of rows), how many trials, and when it is good enough.
FIRST_STEP, STEP_TRIALS, CLOSE_ENOUGH = 5.0, 7, 0.97

# What storing bases and scales in float32 adds to a column's relative error at most.
SINGLE_PRECISION = 3e-7


def compress(
    source: ColumnSource,
    positions: NDArray[np.float64],
    tolerance: float,
    progress: Progress = unwatched,
    map_clusters: MapClusters = map,
) -> CompressedCompliance:
    """Compress a compliance until its worst column is off by no more than the tolerance.

    Uniform block low rank with adaptive precision. L is scaled by its column norms; each cluster
    of some 32 nodes gets one orthonormal basis B_c from the Gram matrix of its far columns;
    ``L_rc ~ B_r M_rc B_c^T`` with M rounded to steps that the tolerance allows, in tiles of 8 or
    16 bits. Blocks of near clusters are whole, 16 bits; blocks L_ii are exact.

    L is never held: each cluster's columns are asked for once, 3n x 96 numbers, and every entry of
    L is compared with its exact value meanwhile. Besides them the couplings before rounding are
    held, about a tenth of a dense float32 L.

    Where that does not reach the tolerance, which very stiff beside very soft parts may cause, a
    second pass knows all norms and keeps near blocks in float32; after it a third one keeps every
    block so, which takes half of a dense float32 L and is always exact enough.

    Parameters
    ----------
    source : exact columns of L.
    positions : (n, 3), of the free surface nodes, metres.
    tolerance : the largest relative error of any column of L, 2-norm, 1e-6 to 0.1.
    progress : called with the share done, 0 to 1; may raise to cancel.
    map_clusters : works on the clusters, an executor's ``map`` for instance.

    Raises
    ------
    PalpateError
        A tolerance out of its range; columns with numbers that are not finite.
    """
    if not SMALLEST_TOLERANCE <= tolerance <= LARGEST_TOLERANCE:
        raise PalpateError(
            f"tolerance: {tolerance} is not between {SMALLEST_TOLERANCE:g} and "
            f"{LARGEST_TOLERANCE:g}; 0.001 keeps every column to a tenth of a percent"
        )
    clusters = cluster_nodes(np.asarray(positions, dtype=np.float64))
    first, second = (share * tolerance for share in CUT_SHARES)
    task = ClusterTask(
        source=source,
        clusters=clusters,
        scale=estimated_scale(source, clusters),
        cut=first,
        near_in_16_bits=tolerance >= SMALLEST_FOR_16_BITS,
    )
    spans = iter(pairwise(PASS_PROGRESS))
    coupling = _coupled(task, map_clusters, progress, next(spans))
    chosen = _coarsest(coupling, tolerance)
    if chosen is None:
        # By then all norms are known.
        task = replace(task, scale=coupling.norms, cut=second, near_in_16_bits=False)
        coupling = _coupled(task, map_clusters, progress, next(spans))
        chosen = _coarsest(coupling, tolerance)
    if chosen is None:
        # Nothing to cut or to round but to float32.
        task = replace(task, clusters=clusters.all_near())
        chosen = _finest(_coupled(task, map_clusters, progress, next(spans)))
    compressed = packed(source.free_surface, *chosen, tolerance)
    progress(1.0)
    return compressed


def _coupled(
    task: ClusterTask,
    map_clusters: MapClusters,
    progress: Progress,
    span: tuple[float, float],
) -> Coupling:
    """One pass over all columns."""
    coupling, (start, end) = Coupling(task.clusters, task.scale), span
    count = task.clusters.count
    for number, part in enumerate(map_clusters(task, range(count)), start=1):
        coupling.add(part)
        progress(start + (end - start) * number / count)
    return coupling


def _column_error(trial: Rounding) -> float:
    """A bound of the largest relative column error."""
    coupling = trial.coupling
    near = np.sqrt(coupling.near_error) / coupling.norms
    # Far and near parts are different rows of a column; cut and rounding may add up.
    return float(np.hypot(near, coupling.cut_errors() + trial.errors).max()) + SINGLE_PRECISION


def _finest(coupling: Coupling) -> tuple[Rounding, float]:
    """For neighbours only, whose couplings are all empty."""
    nothing = Rounding(coupling, 1.0)
    return nothing, _column_error(nothing)


def _coarsest(coupling: Coupling, tolerance: float) -> tuple[Rounding, float] | None:
    """About the coarsest rounding that keeps the tolerance, and its largest column error."""
    step = FIRST_STEP * tolerance / np.sqrt(len(coupling.norms))
    best: tuple[Rounding, float] | None = None
    too_coarse = np.inf
    for _ in range(STEP_TRIALS):
        trial = Rounding(coupling, step)
        error = _column_error(trial)
        if error <= tolerance:
            best = trial, error
            if error > CLOSE_ENOUGH * tolerance:
                break
        else:
            too_coarse = step
        # Rounding errors grow with the step, cut ones do not.
        guess = step * min(max(tolerance / error, 0.1), 2.0)
        finest = 0.0 if best is None else best[0].step
        step = guess if finest < guess < too_coarse else 0.5 * (finest + too_coarse)
    return best
