"""Softenings of the touched place for the corrected force law: computed in the background, stored
next to the body file.

Only computed for that force law; until a place is known, its force is linear.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.servo.session import Body
from ...core.shape.force_at_depth.felt_force import FeltName, felt_name
from ...core.shape.force_at_depth.softening_table import SofteningTable
from ..object.drawn_body import DrawnBody


def chosen_felt(thing: bpy.types.Object) -> FeltName:
    """Force law chosen in the object's panel."""
    return felt_name(thing.palpate.felt.lower())


@dataclass(eq=False)
class FeltTable:
    """Softenings for a press of ``body``, whose native body is ``touched``.

    ``problem`` is the reason for a linear force instead, empty otherwise.
    """

    body: SoftBody
    touched: Body
    body_file: Path | None
    problem: str = ""
    _table: SofteningTable | None = None
    _asked: bytes = b""
    _behind: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, "palpate-felt")
    )

    @property
    def ready(self) -> float:
        """Share (0 to 1) of the touched place's softenings that is known; 1 if none is needed."""
        return 1.0 if self._table is None else self._table.ready

    @property
    def notice(self) -> str:
        """Reason why a file of softenings could not be used; empty otherwise."""
        return "" if self._table is None else self._table.notice

    def follow(self, felt: FeltName, nodes: NDArray[np.int64]) -> None:
        """Request the softenings of touched ``nodes`` (k,) if needed; does not wait."""
        if felt == "linear" or self.problem:
            self._end()
            return
        if self._table is None:
            self._table, self._asked = SofteningTable(self.body, self.body_file), b""
            self._table.listen(self.touched.set_softenings)
        asked = nodes.tobytes()
        if len(nodes) and asked != self._asked:
            try:
                self._table.around(nodes)
            except PalpateError as problem:
                self.problem = problem.sentence
            self._asked = asked

    def close(self) -> None:
        """End background work; its results are kept. Does not wait."""
        self._end()
        self._behind.shutdown(wait=False)

    def _end(self) -> None:
        table, self._table = self._table, None
        if table is not None:
            self._behind.submit(_close, table)


def softenings_for(
    thing: bpy.types.Object, drawn: DrawnBody, places: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """What the force that the panel asks for needs at the surface points nearest to places (m, 3),
    metres; waits for it. None for the linear force.

    Raises
    ------
    PalpateError
        It cannot be computed.
    """
    if chosen_felt(thing) == "linear":
        return None
    triangles = drawn.body.closest_points.query(places).triangle
    table = SofteningTable(drawn.body, drawn.file)
    try:
        table.wait_for(drawn.body.mesh.surface_triangles[triangles])
        return table.values
    finally:
        _close(table)


def _close(table: SofteningTable) -> None:
    try:
        table.close()
    except PalpateError as problem:
        # The press has ended, so there is no report; it is computed again next time.
        print(f"palpate: {problem}")  # noqa: T201
