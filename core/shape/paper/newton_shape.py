"""The shape of (16) with its tables, solved by Newton's method around the touched place.

A table of the whole body takes seconds of Newton's method for each freedom and sign; a press needs
nine freedoms of it. What a press lacks is drawn linearly until it is there.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...errors import CancelledError
from ...files.atomic_file import UnwritableError
from ..solid.free_solid import FreeSolid
from .newton_table import newton_column, usual_largest_force
from .outward_filling import OutwardFilling
from .paper_formula import PaperColumns, paper_displacements
from .table_file import TableFileError, read_table, table_path, write_table

KIND = "newton-table"


class NewtonTable:
    """L^(+F0) and L^(-F0) of a body, by node, as far as they are solved.

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
        self._solid: FreeSolid | None = None
        self._is_cancelled = False

    @property
    def nbytes(self) -> int:
        """Bytes of what is filled."""
        rows = (*self.positive.values(), *self.negative.values())
        return sum(row.nbytes for row in rows) + self.largest.nbytes

    def fill(self, nodes: NDArray[np.int64]) -> None:
        """Solve the freedoms of nodes (k,), counted by their place in ``free_surface``.

        Raises
        ------
        PalpateError
            The pins do not hold the body.
        CancelledError
            By :meth:`cancel`; the node under way is not filled.
        """
        if self._solid is None:
            self._solid = FreeSolid.of(self.body)
        for node in nodes.tolist():
            three = [
                newton_column(self._solid, 3 * node + axis, self.wanted, self._may_go_on)
                for axis in range(3)
            ]
            both = np.stack([column.per_force for column in three], axis=1)
            self.positive[node], self.negative[node] = both
            self.largest[node] = [column.largest for column in three]
            self.is_filled[node] = True

    def cancel(self) -> None:
        """End :meth:`fill` in another thread within an iteration of Newton's method."""
        self._is_cancelled = True

    def _may_go_on(self) -> None:
        if self._is_cancelled:
            raise CancelledError("the table of (16) is not filled further; choose it again")

    def columns(self, nodes: NDArray[np.int64]) -> PaperColumns:
        """What (16) needs of filled nodes (k,): 3k freedoms."""
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
        stored = read_table(path, KIND, self.body.key)
        nodes, largest = stored["nodes"], stored["largest"]
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


class TableShape:
    """A :class:`.shapes.Shape`: equation (16) as published, held in proportion beyond F0.

    Parameters
    ----------
    body : what is drawn.
    body_file : where it came from; the table is kept beside it. None keeps it nowhere.
    wanted : F0 as for :class:`NewtonTable`.
    """

    def __init__(
        self, body: SoftBody, body_file: Path | None = None, wanted: float | None = None
    ) -> None:
        self.table = NewtonTable(body, wanted)
        self._notice = ""
        self._body = body
        self._path = None if body_file is None else table_path(body_file, KIND)
        if self._path is not None:
            self._take_over(self._path)
        self._kept = int(np.count_nonzero(self.table.is_filled))
        surface = body.mesh.nodes[body.compliance.free_surface]
        self._filling = OutwardFilling(surface, self.table.is_filled, self.table.fill, 1)
        self._asked = np.zeros(0, dtype=np.int64)

    @property
    def ready(self) -> float:
        """Share (0 to 1) of the touched nodes that are solved."""
        known = self.table.is_filled[self._asked]
        return float(known.mean()) if known.size else 1.0

    @property
    def notice(self) -> str:
        """Which file could not be used or written, and why; empty otherwise."""
        return self._notice

    def displacements(
        self,
        nodes: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None = None,
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) of the free surface nodes, metres; see :class:`.shapes.Shape`.

        Raises
        ------
        PalpateError
            The table could not be computed.
        """
        modulus = self._body.modulus(young_modulus)
        places, forces = self._on_free_surface(nodes, nodal_forces)
        self._asked = places
        if places.size:
            self._filling.around(places)
        self._raise_problem()
        known = self.table.is_filled[places]
        others = self._body.compliance.free_surface[places[~known]]
        moved = self._body.deform(others, forces[~known], modulus)
        if known.any():
            columns = self.table.columns(places[known])
            corrected = paper_displacements(columns, forces[known].ravel() / modulus)
            moved = moved + corrected.reshape(-1, 3)
        return moved

    def wait_for(self, nodes: NDArray[np.int64]) -> None:
        """Return when these nodes (k,) of the mesh are solved: seconds for each.

        Raises
        ------
        PalpateError
            They cannot be.
        """
        places = self._body.free_index(np.unique(np.asarray(nodes)))
        self._asked = places[places >= 0]
        if self._asked.size:
            self._filling.wait_for(self._asked)

    def close(self) -> None:
        """End what works in the background, and keep what it made. Safe to call twice.

        Where it cannot be kept, :attr:`notice` says why; it is solved again next time.
        """
        self.table.cancel()
        self._filling.close()
        filled = int(np.count_nonzero(self.table.is_filled))
        if self._path is not None and filled > self._kept:
            # Another program may have kept other nodes meanwhile: minutes of work.
            self._take_over(self._path)
            try:
                self.table.save(self._path)
                self._kept = filled
            except UnwritableError as problem:
                self._notice = problem.sentence

    def _take_over(self, path: Path) -> None:
        if not path.exists():
            return
        try:
            self.table.load(path)
        except TableFileError as problem:
            self._notice = problem.sentence

    def _on_free_surface(
        self, nodes: NDArray[np.int64], nodal_forces: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Places (k,) in the free surface, each once, and the forces (k, 3) there."""
        free = self._body.free_index(np.asarray(nodes).reshape(-1))
        forces = np.asarray(nodal_forces, dtype=np.float64).reshape(-1, 3)[free >= 0]
        places, which = np.unique(free[free >= 0], return_inverse=True)
        sums = np.zeros((len(places), 3))
        np.add.at(sums, which, forces)
        return places, sums

    def _raise_problem(self) -> None:
        if self._filling.problem is not None:
            raise self._filling.problem
