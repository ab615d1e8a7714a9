"""Blocks of the compliance for many pairs of surface nodes at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..compliance.dense import DenseCompliance
from .soft_body import SoftBody

# Columns of other forms than the dense one are taken for so many nodes together.
NODES_TOGETHER = 64


def pair_blocks(body: SoftBody, a: NDArray[np.int64], b: NDArray[np.int64]) -> NDArray[np.float64]:
    """L_ab at unit modulus for every pair of surface-local nodes ``a`` (k,), ``b`` (k,): (k, 3, 3).

    A pinned node answers a force on itself as the body's firmest free node, alike in all
    directions (see :attr:`.soft_body.SoftBody.contact_blocks`), and nothing else.
    """
    free = body.free_index(body.mesh.surface_nodes)
    row, column = free[a], free[b]
    blocks = np.zeros((len(a), 3, 3))
    both = np.flatnonzero((row >= 0) & (column >= 0))
    blocks[both] = _free_blocks(body, row[both], column[both])
    pinned = (row < 0) & (a == b)
    blocks[pinned] = np.linalg.inv(body.contact_blocks[a[pinned]])
    return blocks


def _free_blocks(
    body: SoftBody, row: NDArray[np.int64], column: NDArray[np.int64]
) -> NDArray[np.float64]:
    """L_ij of free nodes by their places among ``free_surface``, (k, 3, 3)."""
    compliance = body.compliance
    if isinstance(compliance, DenseCompliance):
        count = compliance.node_count
        # Displacements along the last axis, forces along the second: the block is the transpose.
        found = compliance.table.reshape(count, 3, count, 3)[column, :, row, :]
        return found.transpose(0, 2, 1).astype(np.float64)
    blocks = np.empty((len(row), 3, 3))
    loaded, place = np.unique(column, return_inverse=True)
    order = np.argsort(place, kind="stable")
    starts = np.searchsorted(place[order], np.arange(len(loaded) + 1))
    for first in range(0, len(loaded), NODES_TOGETHER):
        last = min(first + NODES_TOGETHER, len(loaded))
        columns = compliance.columns(loaded[first:last])
        columns = columns.reshape(compliance.node_count, 3, last - first, 3)
        pairs = order[starts[first] : starts[last]]
        blocks[pairs] = columns[row[pairs], :, place[pairs] - first, :]
    return blocks
