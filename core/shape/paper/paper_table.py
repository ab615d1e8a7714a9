"""The tables of (16) of one body, by node, as far as they are filled, and their file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...errors import CancelledError
from ...law.st_venant_kirchhoff import StVenantKirchhoff
from ..solid.free_solid import FreeSolid
from .paper_entries import EntryFinder, usual_largest_force
from .paper_formula import PaperColumns
from .table_file import Layout, TableFileError, read_table, refuse, write_table

# Files of this kind may also be older ones, of which every entry was solved by Newton's method.
KIND = "newton-table"


class PaperTable:
    """L^(+F0) and L^(-F0) of a body, by node, as far as they are found.

    Beside L itself they take twice its memory, as the paper says, once every node is filled.

    Attributes
    ----------
    body : what they belong to.
    wanted : F0 that is tried first, square metres (newton per pascal of Young's modulus).
    is_filled : bool (n,), which free surface nodes are known.
    positive, negative : of every filled node float32 (3, 3n), rows as in the table of
        :class:`palpate.core.compliance.dense.DenseCompliance`.
    largest : float64 (n, 3, 2), F0 of every freedom for positive and negative forces.
    """

    def __init__(self, body: SoftBody, wanted: float | None = None) -> None:
        self.body = body
        self.wanted = usual_largest_force(body.mesh) if wanted is None else wanted
        count = body.compliance.node_count
        self.is_filled = np.zeros(count, dtype=np.bool_)
        self.positive: dict[int, NDArray[np.float32]] = {}
        self.negative: dict[int, NDArray[np.float32]] = {}
        self.largest = np.zeros((count, 3, 2))
        self._finder: EntryFinder | None = None
        self._is_cancelled = False

    @property
    def nbytes(self) -> int:
        """Bytes of what is filled."""
        rows = (*self.positive.values(), *self.negative.values())
        return sum(row.nbytes for row in rows) + self.largest.nbytes

    def fill(self, nodes: NDArray[np.int64]) -> None:
        """Find the entries of nodes (k,), counted by their place in ``free_surface``.

        Raises
        ------
        PalpateError
            The pins do not hold the body.
        CancelledError
            By :meth:`cancel`; the node under way is not filled.
        """
        if self._finder is None:
            self._finder = EntryFinder(FreeSolid.of(self.body, StVenantKirchhoff()))
        for node in nodes.tolist():
            three = [
                self._finder.entries(3 * node + axis, self.wanted, self._may_go_on)
                for axis in range(3)
            ]
            both = np.stack([freedom.per_force for freedom in three], axis=1)
            self.positive[node], self.negative[node] = both
            self.largest[node] = [freedom.largest for freedom in three]
            self.is_filled[node] = True

    def cancel(self) -> None:
        """End :meth:`fill` in another thread within a freedom's series or a step of Newton's."""
        self._is_cancelled = True

    def _may_go_on(self) -> None:
        if self._is_cancelled:
            raise CancelledError("the table of (16) is not filled further; choose it again")

    def columns(self, nodes: NDArray[np.int64]) -> PaperColumns:
        """Columns of filled nodes (k,) for (16): 3k freedoms."""
        return PaperColumns(
            self.body.compliance.columns(nodes).T,
            np.concatenate([self.positive[node] for node in nodes.tolist()]),
            np.concatenate([self.negative[node] for node in nodes.tolist()]),
            self.largest[nodes].reshape(-1, 2),
        )

    def load(self, path: Path) -> None:
        """Take over what a file has.

        Raises
        ------
        TableFileError
            It is damaged, of another body, or for another F0.
        """
        count = len(self.is_filled)
        rows = np.float32, (None, 3, 3 * count)
        layout: Layout = {
            "nodes": (np.int64, (None,)),
            "wanted": (np.float64, ()),
            "largest": (np.float64, (None, 3, 2)),
            "positive": rows,
            "negative": rows,
        }
        stored = read_table(path, KIND, self.body.key, layout)
        nodes, largest = stored["nodes"], stored["largest"]
        if len(np.unique(nodes)) < len(nodes) or (nodes < 0).any() or (nodes >= count).any():
            refuse(path, "nodes")
        for name in ("largest", "positive", "negative"):
            if len(stored[name]) != len(nodes):
                refuse(path, name)
        if (largest <= 0.0).any():
            refuse(path, "largest")
        if float(stored["wanted"]) != self.wanted:
            raise TableFileError(
                "{path}: made for another F0; its table is computed anew", path=path
            )
        self.positive.update(zip(nodes.tolist(), stored["positive"], strict=True))
        self.negative.update(zip(nodes.tolist(), stored["negative"], strict=True))
        self.largest[nodes], self.is_filled[nodes] = largest, True

    def save(self, path: Path) -> None:
        """Write what is filled.

        Raises
        ------
        UnwritableError
            The place cannot be written; an older file stays as it was.
        """
        nodes = np.flatnonzero(self.is_filled)
        arrays = {
            "nodes": nodes,
            "wanted": np.array(self.wanted),
            "largest": self.largest[nodes],
            "positive": self._stacked(self.positive, nodes),
            "negative": self._stacked(self.negative, nodes),
        }
        write_table(path, KIND, self.body.key, arrays)

    def _stacked(
        self, rows: dict[int, NDArray[np.float32]], nodes: NDArray[np.int64]
    ) -> NDArray[np.float32]:
        """Rows of nodes (k,), (k, 3, 3n)."""
        stacked = np.empty((len(nodes), 3, 3 * len(self.is_filled)), dtype=np.float32)
        for place, node in enumerate(nodes.tolist()):
            stacked[place] = rows[node]
        return stacked
