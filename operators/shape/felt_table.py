"""What the corrected felt force needs of the touched place: found behind a press, kept beside the
body file.

Nothing is computed before that force is chosen; until a place is known, it feels linear.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.equations import ContactMode, Touch
from ...core.errors import PalpateError
from ...core.servo.session import Body
from ...core.shape.force_at_depth.felt_fingers import corrected_touches
from ...core.shape.force_at_depth.felt_force import FeltName, felt_name
from ...core.shape.force_at_depth.softening_table import SofteningTable
from ..object.drawn_body import DrawnBody


def chosen_felt(thing: bpy.types.Object) -> FeltName:
    """What the object's panel says."""
    return felt_name(thing.palpate.felt.lower())


@dataclass(eq=False)
class FeltTable:
    """For one press of ``body``, which the servo touches as ``touched``.

    ``problem`` says why the linear force is felt instead, empty otherwise.
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
        """Share (0 to 1) of what the touched place needs that is known; 1 if it needs nothing."""
        return 1.0 if self._table is None else self._table.ready

    @property
    def notice(self) -> str:
        """Which file of softenings could not be used, and why; empty otherwise."""
        return "" if self._table is None else self._table.notice

    def follow(self, felt: FeltName, nodes: NDArray[np.int64]) -> None:
        """Find what the force that is felt needs of touched ``nodes`` (k,); waits for nothing."""
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
        """End what works in the background; what it found is kept. Waits for nothing."""
        self._end()
        self._behind.shutdown(wait=False)

    def _end(self) -> None:
        table, self._table = self._table, None
        if table is not None:
            self._behind.submit(_close, table)


def felt_forces(
    thing: bpy.types.Object,
    drawn: DrawnBody,
    touches: Sequence[Touch],
    young_modulus: float,
    mode: ContactMode,
) -> list[NDArray[np.float64]]:
    """Forces (3,) that point fingers feel, N, by what the panel says; waits for what that needs.

    Raises
    ------
    PalpateError
        They cannot be found.
    """
    if chosen_felt(thing) == "linear":
        return [touch.force for touch in touches]
    table = SofteningTable(drawn.body, drawn.file)
    try:
        table.wait_for(np.concatenate([touch.triangle for touch in touches]))
        found = corrected_touches(drawn.body, table.values, touches, young_modulus, mode)
    finally:
        _close(table)
    return [touch.force for touch in found]


def _close(table: SofteningTable) -> None:
    try:
        table.close()
    except PalpateError as problem:
        # Nobody presses any more who could be told; it is found again next time.
        print(f"palpate: {problem}")  # noqa: T201
