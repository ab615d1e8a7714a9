"""Dense compliance mapped from its file: only the columns in use are read."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..errors import BodyFileError
from ..files.npz_archive import MappedArray
from .dense import DenseCompliance

CHECKSUM_BYTES = 32


def node_checksums(table: NDArray[np.float32]) -> NDArray[np.uint8]:
    """SHA-256 of each node's columns ``table[j]``, (n, 32)."""
    digests = b"".join(hashlib.sha256(np.ascontiguousarray(part).data).digest() for part in table)
    return np.frombuffer(digests, dtype=np.uint8).reshape(-1, CHECKSUM_BYTES)


@dataclass(frozen=True, eq=False)
class MappedCompliance:
    """Compliance whose table is mapped from a body file.

    Every method checks columns before their first use, and that the file has not been truncated
    since it was opened.

    Attributes
    ----------
    free_surface : int64 (n,), node numbers, ascending.
    mapped_table : float32 (n, 3, 3n), as :class:`.dense_compliance.DenseCompliance` has it.
    stored_diagonal : float32 (n, 3, 3), the blocks L_ii, in memory.
    checksums : uint8 (n, 32), see :func:`node_checksums`.
    file : how messages name the file.
    """

    free_surface: NDArray[np.int64]
    mapped_table: MappedArray
    stored_diagonal: NDArray[np.float32]
    checksums: NDArray[np.uint8]
    file: str

    form = "dense"

    @property
    def node_count(self) -> int:
        """Number of free surface nodes, n."""
        return len(self.free_surface)

    @property
    def nbytes(self) -> int:
        """Bytes of the table."""
        return self.mapped_table.array.nbytes

    @property
    def table(self) -> NDArray[np.float32]:
        """The full table, checked."""
        self._check(np.arange(self.node_count))
        table: NDArray[np.float32] = self.mapped_table.array
        return table

    def block(self, i: int, j: int) -> NDArray[np.float64]:
        """L_ij, (3, 3): displacement of node i per force on node j."""
        self._check(np.array([j]))
        return self._unchecked.block(i, j)

    def blocks(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """L_ij for every i of ``rows`` (a,) and j of ``columns`` (b,), (a, b, 3, 3)."""
        self._check(columns)
        return self._unchecked.blocks(rows, columns)

    def diagonal(self) -> NDArray[np.float64]:
        """All blocks L_ii, (n, 3, 3)."""
        return self.stored_diagonal.astype(np.float64)

    def columns(self, nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        """The columns of L for forces on ``nodes`` (k,), as a matrix (3n, 3k)."""
        self._check(nodes)
        return self._unchecked.columns(nodes)

    def apply(
        self, nodal_forces: NDArray[np.float64], nodes: NDArray[np.int64] | None = None
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) under ``nodal_forces`` (k, 3) on ``nodes`` (k,); equation (15).

        Without ``nodes`` there is one force for every node, (n, 3).
        """
        self._check(np.arange(self.node_count) if nodes is None else nodes)
        return self._unchecked.apply(nodal_forces, nodes)

    @cached_property
    def _unchecked(self) -> DenseCompliance:
        return DenseCompliance(self.free_surface, self.mapped_table.array)

    @cached_property
    def _is_checked(self) -> NDArray[np.bool_]:
        return np.zeros(self.node_count, dtype=bool)

    def check_length(self) -> None:
        """Make sure that the file still has the full table.

        Raises
        ------
        BodyFileError
            It was truncated.
        """
        if not self.mapped_table.is_complete:
            raise BodyFileError("{file}: it was cut short while in use; bake again", file=self.file)

    def _check(self, nodes: NDArray[np.int64]) -> None:
        """Make sure that the columns of ``nodes`` are what was stored.

        Raises
        ------
        BodyFileError
            They are not, or the file was truncated.
        """
        self.check_length()
        if self._is_checked[nodes].all():
            return
        for node in np.unique(nodes[~self._is_checked[nodes]]):
            if not self._is_as_stored(node):
                raise BodyFileError(
                    "{file}: damaged (the compliance of node {node} does not match its checksum); "
                    "bake again",
                    file=self.file,
                    node=self.free_surface[node],
                )
            if not np.isfinite(self.mapped_table.array[node]).all():
                raise BodyFileError(
                    "{file}: the compliance of node {node} has numbers that are not finite; bake "
                    "again",
                    file=self.file,
                    node=self.free_surface[node],
                )
            self._is_checked[node] = True

    def undamaged(self, nodes: NDArray[np.int64]) -> NDArray[np.int64]:
        """Those of ``nodes`` whose columns are what was stored; others are refused when used."""
        self.check_length()
        return nodes[[self._is_as_stored(node) for node in nodes.tolist()]]

    def _is_as_stored(self, node: int) -> bool:
        found = hashlib.sha256(self.mapped_table.array[node].data).digest()
        return bool(found == self.checksums[node].tobytes())
