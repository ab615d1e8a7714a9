"""The shape ``series``: power series in the force, of the whole load or of each loaded freedom.

The sum over freedoms, as (16) has it, leaves out what the nine freedoms of a touched triangle do
together, some two thirds of the second order of a press in its middle. A body whose solves fit in a
frame is therefore drawn by the series of the whole load, two solves a frame, which needs no table
and errs five to thirty times less. Larger bodies are drawn from a table of freedoms
(:mod:`.series_table`), filled around the touched place in the background and kept beside the body's
file, and from what the touched freedoms do together in the second order (:mod:`.series_pairs`).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...errors import PalpateError
from ...files.atomic_file import UnwritableError
from ...stiffness.freedoms import freedoms
from ..solid.free_solid import FreeSolid
from .continued_powers import continued_powers
from .outward_filling import OutwardFilling
from .power_series import ORDER, SeriesSolid
from .series_entries import trusted_share
from .series_pairs import SeriesPairs
from .series_table import KIND, SeriesTable
from .table_file import TableFileError, table_path

# Free nodes up to which a frame has time for the series of the whole load: some 10 ms of 16.
LARGEST_WHOLE_LOAD = 2500
# The series of a load goes on straight where its third order is this share of the first: at 0.01
# it follows less far than it could, beyond 0.1 it overshoots.
LOAD_SHARE = 0.05
# Nodes times tetrahedra in one slice of the background: three nodes of a body of 1,700, some 0.1 s,
# and one of a body of 20,000, with 200 MB of strains.
SLICE = 25_000
MOST_NODES_AT_ONCE = 3
# Seconds that closing waits for a slice under way; on a large body it may take longer, and is lost.
PATIENCE = 0.25


def load_displacements(solid: SeriesSolid, forces: NDArray[np.float64]) -> NDArray[np.float64]:
    """Displacements (n, 3) of the free surface by the series of one load, (f, 3), at 1 Pa.

    Once continuously differentiable in the size of the load, continuous in its direction.
    """
    surface = solid.body.surface
    terms = [term[surface] for term in solid.terms(forces[:, :, None], ORDER)]
    if not terms[0].any():
        return terms[0][:, :, 0]
    square, cube = continued_powers(np.ones(1), trusted_share(terms, LOAD_SHARE))
    moved: NDArray[np.float64] = terms[0] + square * terms[1] + cube * terms[2]
    return moved[:, :, 0]


class SeriesShape:
    """A :class:`.shapes.Shape` by power series.

    Parameters
    ----------
    body : what is drawn.
    body_file : the table is kept beside it; without it, it is not kept.
    whole_load : whether every frame computes the series of the whole load, or sums over the
        freedoms of a table; None chooses by the number of nodes.
    """

    def __init__(
        self, body: SoftBody, body_file: Path | None = None, whole_load: bool | None = None
    ) -> None:
        self._body = body
        self._path = None if body_file is None else table_path(body_file, KIND)
        free = len(body.mesh.nodes) - len(body.fixed)
        self._by_load = free <= LARGEST_WHOLE_LOAD if whole_load is None else whole_load
        self._solid: SeriesSolid | None = None
        self._table: SeriesTable | None = None
        self._pairs = SeriesPairs()
        self._kept = 0
        self._places = np.zeros(0, dtype=np.int64)
        # Freedoms that were wanted at once, and could be polished when nobody waits.
        self._unpolished = np.zeros(0, dtype=np.int64)
        self._notice = ""
        surface = body.compliance.free_surface
        self._is_filled = np.zeros(len(surface), dtype=bool)
        self._filling = OutwardFilling(
            body.mesh.nodes[surface],
            self._is_filled,
            self._fill,
            max(1, min(SLICE // len(body.mesh.tets), MOST_NODES_AT_ONCE)),
            self._prepare,
            self._complete,
        )

    @property
    def table(self) -> SeriesTable | None:
        """The table of freedoms, once it is there; None where none is needed."""
        return self._table

    @property
    def ready(self) -> float:
        """Share of the nodes touched last that need not be drawn linear."""
        if not len(self._places):
            return 1.0
        return float(self._is_filled[self._places].mean())

    @property
    def notice(self) -> str:
        """Which file could not be used or written, and why; empty otherwise."""
        return self._notice

    @property
    def is_prepared(self) -> bool:
        """Whether all is there that does not depend on the touched place, the factor above all."""
        return self._filling.is_prepared

    @property
    def filled_share(self) -> float:
        """Share of the free surface nodes that need not be drawn linear."""
        return float(self._is_filled.mean())

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
            What is needed cannot be computed.
        """
        numbers = np.asarray(nodes, dtype=np.int64).reshape(-1)
        self._touch(numbers)
        if (problem := self._filling.problem) is not None:
            raise PalpateError("shape series: {problem}", problem=problem) from problem
        if self._by_load and (solid := self._solid) is not None:
            modulus = self._body.modulus(young_modulus)
            forces = np.asarray(nodal_forces, dtype=np.float64).reshape(-1, 3) / modulus
            return load_displacements(solid, solid.body.on_free_nodes(numbers, forces))
        if not self._by_load and (table := self._table) is not None:
            return self._by_freedoms(table, numbers, nodal_forces, young_modulus)
        return self._body.deform(numbers, nodal_forces, young_modulus)

    def wait_for(self, nodes: NDArray[np.int64]) -> None:
        """Return when all is there that forces on these nodes (k,) of the mesh need.

        Raises
        ------
        PalpateError
            It cannot be computed.
        """
        self._touch(np.asarray(nodes, dtype=np.int64).reshape(-1))
        self._filling.wait_for(self._places)

    def finish(self) -> None:
        """Fill the whole table; returns at once where none is needed."""
        self._filling.finish()

    def close(self) -> None:
        """End what works in the background, and keep what it made. Safe to call twice.

        Where it cannot be kept, :attr:`notice` says why; it is computed again next time.
        """
        self._filling.close(PATIENCE)
        self._keep()

    def _touch(self, nodes: NDArray[np.int64]) -> None:
        places = self._body.free_index(nodes)
        self._places = np.unique(places[places >= 0])
        self._filling.around(self._places)

    def _prepare(self) -> None:
        """What comes before any entry; in the background."""
        if not self._by_load:
            self._table = self._kept_table()
            self._is_filled[:] = self._table.has(np.arange(len(self._is_filled)))
            self._kept = int(self._is_filled.sum())
            if self._is_filled.all():
                return
        self._solid = self._made_solid()
        if self._by_load:
            self._is_filled[:] = True

    def _made_solid(self) -> SeriesSolid:
        solid = SeriesSolid(FreeSolid.of(self._body))
        _ = solid.body.factor, solid.fields
        return solid

    def _kept_table(self) -> SeriesTable:
        if self._path is not None and self._path.exists():
            try:
                return SeriesTable.load(self._body, self._path)
            except TableFileError as problem:
                self._notice = problem.sentence
        return SeriesTable.empty(self._body)

    def _filled_in_file(self, path: Path) -> int:
        """How many places the table in the file has; 0 where it is of no use."""
        if not path.exists():
            return 0
        try:
            stored = SeriesTable.load(self._body, path)
        except TableFileError:
            return 0
        return int(stored.has(np.arange(len(self._is_filled))).sum())

    def _by_freedoms(
        self,
        table: SeriesTable,
        nodes: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None,
    ) -> NDArray[np.float64]:
        moved = table.displacements(nodes, nodal_forces, young_modulus)
        places, loads = table.loads(nodes, nodal_forces, young_modulus)
        if not self._is_filled[places].all():
            return moved
        largest = table.largest_force.reshape(-1, 3)[places]
        return moved + self._pairs.displacements(places, loads, largest)

    def _complete(self, places: NDArray[np.int64]) -> None:
        """What touched freedoms do together; in the background."""
        if not self._by_load:
            if self._solid is None:
                self._solid = self._made_solid()
            self._pairs.fill(self._solid, places)

    def _fill(self, places: NDArray[np.int64]) -> None:
        if self._table is None or self._solid is None:
            raise AssertionError("filled before it was prepared")
        table, wanted = self._table, freedoms(places)
        if np.isin(places, self._places).all():
            short = table.fill(self._solid, wanted, may_polish=False)
            self._unpolished = np.concatenate([self._unpolished, short])
        else:
            table.fill(self._solid, np.concatenate([wanted, self._unpolished]))
            self._unpolished = self._unpolished[:0]
        self._is_filled[places] = True
        if self._is_filled.all():
            if len(self._unpolished):
                table.fill(self._solid, self._unpolished)
            self._keep()

    def _keep(self) -> None:
        filled = int(self._is_filled.sum())
        if self._table is None or self._path is None or filled <= self._kept:
            return
        try:
            # Another program may have kept more meanwhile.
            if filled > self._filled_in_file(self._path):
                self._table.save(self._path)
            self._kept = filled
        except UnwritableError as problem:
            self._notice = problem.sentence
