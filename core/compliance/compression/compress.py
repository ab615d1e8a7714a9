"""Compression of the compliance from its exact columns, in one pass."""

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
from .interactions import Interactions
from .packing import packed
from .tiles import Rounding

# Calls the task for each cluster number and yields the results in order, as map does.
MapClusters = Callable[[ClusterTask, Iterable[int]], Iterable[ClusterColumns]]

SMALLEST_TOLERANCE, LARGEST_TOLERANCE = 1e-6, 0.1

# Share of the tolerance that cutting bases may use, in the first and in the second pass; rounding,
# whose accuracy costs less memory, gets the rest.
CUT_SHARES = (0.3, 0.05)

# Near blocks of 16 bits err by about 1e-4 of a column; below this tolerance they are float32.
SMALLEST_FOR_16_BITS = 3e-4

# Progress at the limits of the passes; more than one is rare.
PASS_PROGRESS = (0.0, 0.85, 0.95, 0.98)

# Search for the coarsest step: its start (times the tolerance over the root of the number of rows),
# the number of trials, and the share of the tolerance that ends it.
FIRST_STEP, STEP_TRIALS, CLOSE_ENOUGH = 5.0, 7, 0.97

# Bound of a column's relative error from float32 bases and scales.
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
    16 bits. Blocks of near clusters are full, 16 bits; blocks L_ii are exact.

    L is never held: each cluster's columns are computed once, 3n x 96 numbers, and every entry of L
    is compared with its exact value. The interactions before rounding are held besides, about a
    tenth of a dense float32 L.

    Where this misses the tolerance, as very stiff parts next to very soft ones may cause, a second
    pass uses exact norms and float32 near blocks; a third one stores every block in float32, half
    of a dense float32 L, which always suffices.

    Parameters
    ----------
    source : exact columns of L.
    positions : (n, 3), of the free surface nodes, metres.
    tolerance : the largest relative error of any column of L, 2-norm, 1e-6 to 0.1.
    progress : called with the share done, 0 to 1; may raise to cancel.
    map_clusters : runs the task for the clusters, for example an executor's ``map``.

    Raises
    ------
    PalpateError
        A tolerance out of its range; columns with numbers that are not finite.
    """
    if not SMALLEST_TOLERANCE <= tolerance <= LARGEST_TOLERANCE:
        raise PalpateError(
            "tolerance: {tolerance} is not between {least:g} and {most:g}; 0.001 keeps every "
            "column to a tenth of a percent",
            tolerance=tolerance,
            least=SMALLEST_TOLERANCE,
            most=LARGEST_TOLERANCE,
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
    interactions = _interactions(task, map_clusters, progress, next(spans))
    chosen = _coarsest(interactions, tolerance)
    if chosen is None:
        # All norms are known by now.
        task = replace(task, scale=interactions.norms, cut=second, near_in_16_bits=False)
        interactions = _interactions(task, map_clusters, progress, next(spans))
        chosen = _coarsest(interactions, tolerance)
    if chosen is None:
        # Neither cut nor rounded, except to float32.
        task = replace(task, clusters=clusters.all_near())
        chosen = _finest(_interactions(task, map_clusters, progress, next(spans)))
    compressed = packed(source.free_surface, *chosen, tolerance)
    progress(1.0)
    return compressed


def _interactions(
    task: ClusterTask,
    map_clusters: MapClusters,
    progress: Progress,
    span: tuple[float, float],
) -> Interactions:
    """Interactions from one pass over all columns."""
    interactions, (start, end) = Interactions(task.clusters, task.scale), span
    count = task.clusters.count
    for number, part in enumerate(map_clusters(task, range(count)), start=1):
        interactions.add(part)
        progress(start + (end - start) * number / count)
    return interactions


def _column_error(trial: Rounding) -> float:
    """Bound of the largest relative column error."""
    interactions = trial.interactions
    near = np.sqrt(interactions.near_error) / interactions.norms
    # Far and near parts are different rows of a column; errors of cut and rounding may add up.
    return float(np.hypot(near, interactions.cut_errors() + trial.errors).max()) + SINGLE_PRECISION


def _finest(interactions: Interactions) -> tuple[Rounding, float]:
    """Rounding where all clusters are neighbours: every interaction is empty."""
    nothing = Rounding(interactions, 1.0)
    return nothing, _column_error(nothing)


def _coarsest(interactions: Interactions, tolerance: float) -> tuple[Rounding, float] | None:
    """Nearly coarsest rounding within the tolerance, and its largest column error."""
    step = FIRST_STEP * tolerance / np.sqrt(len(interactions.norms))
    best: tuple[Rounding, float] | None = None
    too_coarse = np.inf
    for _ in range(STEP_TRIALS):
        trial = Rounding(interactions, step)
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
