"""The shape of (16): its tables around the touched place, filled in the background.

What a press lacks is drawn linearly until it is there.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...files.atomic_file import UnwritableError
from .outward_filling import OutwardFilling
from .paper_formula import paper_displacements
from .paper_table import KIND, PaperTable
from .table_file import TableFileError, table_path

# Of a table: beyond this nodes are filled only when they are touched.
MOST_BYTES = 1_000_000_000


class PaperShape:
    """A :class:`.shapes.Shape`: equation (16) as published, held in proportion beyond F0.

    Parameters
    ----------
    body : what is drawn.
    body_file : where it came from; the table is kept beside it. None keeps it nowhere.
    wanted : F0 as for :class:`PaperTable`.
    remark : what :attr:`notice` says as long as there is no trouble.
    """

    def __init__(
        self,
        body: SoftBody,
        body_file: Path | None = None,
        wanted: float | None = None,
        remark: str = "",
    ) -> None:
        self.table = PaperTable(body, wanted)
        self._notice = remark
        self._body = body
        self._path = None if body_file is None else table_path(body_file, KIND)
        if self._path is not None:
            self._take_over(self._path)
        self._kept = int(np.count_nonzero(self.table.is_filled))
        surface = body.mesh.nodes[body.compliance.free_surface]
        most = MOST_BYTES // max(1, 2 * 3 * surface.size * np.dtype(np.float32).itemsize)
        self._filling = OutwardFilling(surface, self.table.is_filled, self.table.fill, 1, most)
        self._asked = np.zeros(0, dtype=np.int64)

    @property
    def ready(self) -> float:
        """Share (0 to 1) of the touched nodes that are filled."""
        known = self.table.is_filled[self._asked]
        return float(known.mean()) if known.size else 1.0

    @property
    def notice(self) -> str:
        """Which file could not be used or written, and why; else the remark."""
        return self._notice

    def displacements(
        self,
        nodes: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None = None,
        let_go: NDArray[np.float64] | None = None,  # noqa: ARG002 - of bodies that pins hold
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
        if self._filling.problem is not None:
            raise self._filling.problem
        known = self.table.is_filled[places]
        others = self._body.compliance.free_surface[places[~known]]
        moved = self._body.deform(others, forces[~known], modulus)
        if known.any():
            columns = self.table.columns(places[known])
            corrected = paper_displacements(columns, forces[known].ravel() / modulus)
            moved = moved + corrected.reshape(-1, 3)
        return moved

    def wait_for(self, nodes: NDArray[np.int64]) -> None:
        """Return when these nodes (k,) of the mesh are filled: tenths of a second for each.

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

        Where it cannot be kept, :attr:`notice` says why; it is computed again next time.
        """
        self.table.cancel()
        self._filling.close()
        filled = int(np.count_nonzero(self.table.is_filled))
        if self._path is not None and filled > self._kept:
            # Another program may have kept other nodes meanwhile.
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
