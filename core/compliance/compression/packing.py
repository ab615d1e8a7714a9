"""Layout of rounded interactions and near blocks as the plain arrays of the result."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .cluster_columns import LARGEST_16_BITS
from .compressed_arrays import TILE
from .compressed_compliance import CompressedCompliance
from .interactions import Interactions
from .tiles import LARGEST_8_BITS, Rounding


def packed(
    free_surface: NDArray[np.int64],
    chosen: Rounding,
    column_error: float,
    tolerance: float,
) -> CompressedCompliance:
    """Compressed compliance, its clusters in order of their ranks.

    Clusters of equal rank are then adjacent, and their bases multiplied in one call.
    """
    interactions = chosen.interactions
    tile_counts = _tile_counts(chosen)
    order = np.argsort(tile_counts, kind="stable")
    number = np.argsort(order)
    clusters = interactions.clusters
    leaf = max(len(nodes) for nodes in clusters.members)
    places = np.empty(len(free_surface), np.int32)
    own_blocks = np.empty((len(free_surface), 3, 3))
    scale = np.zeros((clusters.count, 3 * leaf), np.float32)
    basis = []
    for new, old in enumerate(order):
        nodes = clusters.members[old]
        places[nodes] = new * leaf + np.arange(len(nodes))
        own_blocks[nodes] = interactions.diagonals[old]
        own = interactions.scale[clusters.span(old)]
        scale[new, : len(own)] = own
        scaled = np.zeros((3 * leaf, TILE * tile_counts[old]), np.float32)
        scaled[: len(own)] = own[:, None] * interactions.bases[old][:, : scaled.shape[1]]
        basis.append(scaled.ravel())
    near_table, near, near_steps = _near(interactions, number, leaf)
    tile_table, narrow, wide = _tiles(chosen, tile_counts, number)
    return CompressedCompliance(
        free_surface=free_surface,
        tolerance=tolerance,
        column_error=np.array(column_error),
        places=places,
        own_blocks=own_blocks,
        near_scale=np.sqrt(scale),
        near_table=near_table,
        near_steps=near_steps,
        near=near,
        tile_counts=tile_counts[order].astype(np.int32),
        basis=np.concatenate(basis),
        steps=chosen.steps[order],
        tile_table=tile_table,
        narrow=narrow,
        wide=wide,
    )


def _tile_counts(chosen: Rounding) -> NDArray[np.int64]:
    """Number of tiles of each cluster's basis that any interaction uses, (q,)."""
    interactions = chosen.interactions
    counts = np.zeros(interactions.clusters.count, np.int64)
    all_tiles = np.array([basis.shape[1] // TILE for basis in interactions.bases])
    firsts = np.concatenate([[0], np.cumsum(all_tiles)])
    for cluster in range(interactions.clusters.count):
        rounded = chosen.rounded(cluster)
        counts[cluster] = max(counts[cluster], _past_last(np.any(rounded.used, axis=0)))
        rows: NDArray[np.bool_] = np.any(rounded.used, axis=1)
        for row in range(cluster):
            counts[row] = max(counts[row], _past_last(rows[firsts[row] : firsts[row + 1]]))
    return counts


def _past_last(used: NDArray[np.bool_]) -> int:
    places = np.flatnonzero(used)
    return int(places[-1]) + 1 if len(places) else 0


def _near(
    interactions: Interactions, number: NDArray[np.int64], leaf: int
) -> tuple[NDArray[np.int32], NDArray[np.int16] | NDArray[np.float32], NDArray[np.float32]]:
    count = interactions.clusters.count
    table = np.zeros((count, count), np.int32)
    total = sum(len(blocks) for blocks in interactions.near)
    near = np.zeros((total, 3 * leaf, 3 * leaf), interactions.near[0][0].numbers.dtype)
    steps = np.empty(total, np.float32)
    place = 0
    for cluster, blocks in enumerate(interactions.near):
        for block in blocks:
            row, column, numbers = number[block.row], number[cluster], block.numbers
            if row > column:
                row, column, numbers = column, row, numbers.T
            near[place, : numbers.shape[0], : numbers.shape[1]] = numbers
            steps[place] = block.step
            place += 1
            table[row, column] = table[column, row] = place
    return table, near, steps


def _tiles(
    chosen: Rounding,
    tile_counts: NDArray[np.int64],
    number: NDArray[np.int64],
) -> tuple[NDArray[np.int32], NDArray[np.int8], NDArray[np.int16] | NDArray[np.int32]]:
    """Table of tiles, the 8-bit tiles, and the wider ones."""
    interactions = chosen.interactions
    new_counts = np.empty_like(tile_counts)
    new_counts[number] = tile_counts
    new_firsts = np.concatenate([[0], np.cumsum(new_counts)])
    # New place of each tile of each old basis; those beyond a cluster's count are not used.
    moved = np.concatenate(
        [
            new_firsts[number[cluster]] + np.arange(basis.shape[1] // TILE)
            for cluster, basis in enumerate(interactions.bases)
        ]
    )
    firsts = np.concatenate(
        [[0], np.cumsum([basis.shape[1] // TILE for basis in interactions.bases])]
    )
    rows, columns, tiles = [], [], []
    for cluster in range(interactions.clusters.count):
        rounded = chosen.rounded(cluster)
        above, own = np.nonzero(rounded.used)
        shape = (rounded.used.shape[0], TILE, rounded.used.shape[1], TILE)
        numbers = rounded.numbers.astype(np.int32).reshape(shape)
        numbers = numbers.transpose(0, 2, 1, 3)[above, own]
        row, column = moved[above], moved[firsts[cluster] + own]
        turned = row > column
        numbers[turned] = numbers[turned].transpose(0, 2, 1)
        rows.append(np.where(turned, column, row))
        columns.append(np.where(turned, row, column))
        tiles.append(numbers)
    row, column = np.concatenate(rows), np.concatenate(columns)
    order = np.lexsort((column, row))
    row, column, numbers = row[order], column[order], np.concatenate(tiles)[order]
    is_wide = np.abs(numbers).max(axis=(1, 2), initial=0) > LARGEST_8_BITS
    # Number 0 is the tile of zeros, for no tile; wide ones count down from -1.
    places = np.where(is_wide, -np.cumsum(is_wide), np.cumsum(~is_wide))
    table = np.zeros((new_firsts[-1], new_firsts[-1]), np.int32)
    table[row, column] = table[column, row] = places
    narrow = np.zeros((1 + np.count_nonzero(~is_wide), TILE, TILE), np.int8)
    narrow[1:] = numbers[~is_wide]
    few_bits = np.abs(numbers).max(initial=0) <= LARGEST_16_BITS
    return table, narrow, numbers[is_wide].astype(np.int16 if few_bits else np.int32)
