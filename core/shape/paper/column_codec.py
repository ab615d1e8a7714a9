"""Displacements of the free surface in few bytes, one column at a time.

The surface is cut into clusters of neighbours. Seen from elsewhere, a cluster moves in a few smooth
patterns, those in which loads on other clusters move it; in an orthonormal basis that begins with
them, most of a column's numbers are nearly zero. They are rounded to whole multiples of a step that
keeps the error below what is allowed, and packed. The error is measured, not estimated. A column
needs no other column, so that a table may be filled in any order.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...compliance.compression.clusters import cluster_nodes
from ...compliance.protocol import Compliance
from ...stiffness.freedoms import freedoms

# How much the step may exceed the one that keeps the error even if no number rounds to zero.
STEP_FACTORS = 2.0 ** np.arange(6.0, -2.0, -0.5)
LARGEST_NUMBER = 32_767
PACKING_LEVEL = 6


@dataclass(frozen=True, eq=False)
class ColumnCodec:
    """Between columns (3n,) and bytes.

    Attributes
    ----------
    members : nodes of each cluster, (about 32,) each.
    bases : float32 (3a, 3a) orthonormal columns for each cluster of a nodes, smoothest first.
    """

    members: tuple[NDArray[np.int64], ...]
    bases: tuple[NDArray[np.float32], ...]

    @classmethod
    def of(cls, positions: NDArray[np.float64], compliance: Compliance) -> ColumnCodec:
        """Of the free surface nodes at ``positions`` (n, 3)."""
        members = cluster_nodes(positions).members
        sample = np.array([nodes[len(nodes) // 2] for nodes in members])
        moved = compliance.columns(sample)
        moved = moved / np.linalg.norm(moved, axis=0)
        bases = []
        for nodes in members:
            rows = moved[freedoms(nodes)]
            _, vectors = np.linalg.eigh(rows @ rows.T)
            bases.append(vectors[:, ::-1].astype(np.float32))
        return cls(members, tuple(bases))

    def encode(
        self, columns: NDArray[np.float64], allowed: NDArray[np.float64]
    ) -> tuple[list[bytes], NDArray[np.float64], NDArray[np.float64]]:
        """Columns (3n, k) as bytes, with their steps (k,) and the errors (k,) that were made.

        ``allowed`` (k,) is the largest error, as a Euclidean norm; where even the finest step errs
        more, which takes numbers beyond 16 bits of it, the error that is returned says so.
        """
        smooth = self._transformed(columns)
        size, count = smooth.shape
        finest = allowed * np.sqrt(12.0 / size)
        steps, errors = np.zeros(count), np.full(count, np.inf)
        numbers = np.zeros((size, count), dtype=np.int16)
        for factor in STEP_FACTORS:
            waiting = np.flatnonzero(errors > allowed)
            if not waiting.size:
                break
            step = np.maximum(factor * finest[waiting], np.finfo(np.float64).tiny)
            rounded = np.rint(smooth[:, waiting] / step)
            rounded = np.clip(rounded, -LARGEST_NUMBER, LARGEST_NUMBER)
            error = np.linalg.norm(rounded * step - smooth[:, waiting], axis=0)
            better = error < errors[waiting]
            taken = waiting[better]
            steps[taken], errors[taken] = step[better], error[better]
            numbers[:, taken] = rounded[:, better]
        return [_packed(column) for column in numbers.T], steps, errors

    def decode(self, packed: bytes, step: float) -> NDArray[np.float32]:
        """The column (3n,) of bytes that :meth:`encode` made."""
        smooth = np.float32(step) * _unpacked(packed).astype(np.float32)
        column = np.empty(len(smooth), dtype=np.float32)
        start = 0
        for nodes, basis in zip(self.members, self.bases, strict=True):
            stop = start + len(basis)
            column[freedoms(nodes)] = basis @ smooth[start:stop]
            start = stop
        return column

    def _transformed(self, columns: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.concatenate(
            [
                basis.T @ columns[freedoms(nodes)]
                for nodes, basis in zip(self.members, self.bases, strict=True)
            ]
        )


def _packed(numbers: NDArray[np.int16]) -> bytes:
    """Low bytes, then high ones, which are nearly all alike."""
    halves = numbers.astype("<i2").view(np.uint8).reshape(-1, 2).T
    return zlib.compress(np.ascontiguousarray(halves).tobytes(), PACKING_LEVEL)


def _unpacked(packed: bytes) -> NDArray[np.int16]:
    halves = np.frombuffer(zlib.decompress(packed), dtype=np.uint8).reshape(2, -1)
    numbers: NDArray[np.int16] = np.ascontiguousarray(halves.T).view("<i2").ravel()
    return numbers
