"""Shape drawn by a press: made in the background, exchangeable during the press.

Until it is ready, and where it cannot be made, the linear one is drawn.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.servo.session import Snapshot, drawn_loads
from ...core.shape.found_behind import FoundBehind
from ...core.shape.meeting import Meeting, Met
from ...core.shape.rotation_strain.finger_load import FingerLoad
from ...core.shape.shapes import (
    LinearShape,
    Shape,
    is_felt,
    pressed_by,
    rest_known,
    shape,
    shape_name,
)
from ..object.drawn_body import DrawnBody

Array = NDArray[np.float64]

# Longest wait for a kept shape's table, s.
PATIENCE = 3.0


def chosen_shape(thing: bpy.types.Object) -> str:
    """Shape chosen in the object's panel, or by an older file: also a former name."""
    name: str = thing.palpate.shape.lower().replace("_", "-")
    return name


@dataclass(eq=False)
class DrawnShape:
    """Shape of a body under its fingers.

    Attributes
    ----------
    name : of the chosen shape.
    problem : why the linear one is drawn instead, empty otherwise.
    """

    body: SoftBody
    body_file: Path | None
    name: str = "linear"
    problem: str = ""
    _shape: Shape = field(init=False)
    _meeting: Meeting = field(init=False)
    _making: Future[Shape] | None = None
    _behind: ThreadPoolExecutor | None = None

    def __post_init__(self) -> None:
        self._take(LinearShape(self.body))

    @property
    def ready(self) -> float:
        """Share (0 to 1) of the touched place's table that is ready."""
        return 0.0 if self._making is not None else self._shape.ready

    @property
    def notice(self) -> str:
        """Reason why a table's file could not be used; empty otherwise."""
        return self._shape.notice

    @property
    def made(self) -> Shape:
        """The shape that is drawn: the linear one until the chosen one is made."""
        return self._shape

    def follow(self, name: str, law: str) -> None:
        """Draw this shape, of a body of this law, as soon as it is ready. Does not wait."""
        if name != self.name or law != self.body.law:
            self._end()
            self.name, self.problem = name, ""
            self.body = replace(self.body, law=law)
            self._take(LinearShape(self.body))
            if name != "linear":
                if self._behind is None:
                    self._behind = ThreadPoolExecutor(1, "palpate-shape")
                self._making = self._behind.submit(shape, self.body, name, self.body_file)
        if self._making is not None and self._making.done():
            self._take_made()

    def at_rest(self, touch: Sequence[FingerLoad], young_modulus: float) -> Array | None:
        """Displacements (n, 3) where the force of this very touch was found already; at once."""
        return rest_known(self._shape, touch, young_modulus)

    def draw(self, fingers: Sequence[FingerLoad], young_modulus: float) -> Met:
        """Displacements under these fingers; linear until the shape is ready."""
        try:
            met = self._meeting.step(fingers, young_modulus)
        except PalpateError as problem:
            self.problem = problem.sentence
            self._end()
            self._take(LinearShape(self.body))
            return self._meeting.step(fingers, young_modulus)
        if self._shape.ready < 1.0:
            self._take(self._shape)
            return Met(met.linear, met.linear, 0.0)
        return met

    def finish(
        self, fingers: Sequence[FingerLoad], touch: Sequence[FingerLoad], young_modulus: float
    ) -> Met:
        """Displacements under these fingers, after waiting for the shape for a limited time; where
        its own force is felt, at rest under their ``touch``.
        """
        end = time.monotonic() + PATIENCE
        self._take_made()
        met = self.draw(fingers, young_modulus)
        while self.ready < 1.0 and not self.problem and time.monotonic() < end:
            time.sleep(0.01)
            met = self.draw(fingers, young_modulus)
        if touch and self.ready == 1.0 and not self.problem:
            rest = pressed_by(self._shape, touch, young_modulus).displacements
            if rest is not None:
                return Met(rest, met.linear, 0.0)
        return met if met.settled else self._meeting.settle(fingers, young_modulus)

    def close(self) -> None:
        """End background work; its results are kept. Does not wait."""
        self._end()
        self._take(LinearShape(self.body))
        if self._behind is not None:
            self._behind.shutdown(wait=False)
            self._behind = None

    def _take_made(self) -> None:
        """Take the shape made in the background, waiting if necessary."""
        making, self._making = self._making, None
        if making is None:
            return
        try:
            self._take(making.result())
        except PalpateError as problem:
            self.problem = problem.sentence

    def _take(self, made: Shape) -> None:
        self._shape, self._meeting = made, Meeting(self.body, made)

    def _end(self) -> None:
        """Close the shape in the background, since files may be written."""
        if self._behind is None:
            return
        making, self._making = self._making, None
        if making is not None:
            self._behind.submit(_close_made, making)
        else:
            self._behind.submit(_close, self._shape)


@contextmanager
def closing_shape(thing: bpy.types.Object, drawn: DrawnBody) -> Iterator[Shape]:
    """Shape chosen in the object's panel; closed in the end.

    Raises
    ------
    PalpateError
        It cannot be computed.
    """
    made = shape(drawn.at_rest, chosen_shape(thing), drawn.file)
    try:
        yield made
    finally:
        made.close()


def found_behind(thing: bpy.types.Object, drawn: DrawnBody) -> FoundBehind | None:
    """A body of the chosen shape whose loads change, where that shape tells the force, too."""
    name = shape_name(chosen_shape(thing))
    if name != "real" or not is_felt(drawn.body):
        return None
    return FoundBehind(drawn.body, _last_real(drawn.at_rest), thing.palpate.young_modulus)


def kept_shape(thing: bpy.types.Object, drawn: DrawnBody) -> Shape:
    """The chosen shape of an object that nobody holds, which has none of the paper's."""
    if shape_name(chosen_shape(thing)) == "real":
        return _last_real(drawn.at_rest)
    return LinearShape(drawn.at_rest)


@lru_cache(maxsize=8)
def _last_real(body: SoftBody) -> Shape:
    """Prepared once for the many strokes on an object, and on those beside it."""
    return shape(body, "real")


def loads_of(body: SoftBody, snapshot: Snapshot, let_go: Array | None) -> list[FingerLoad]:
    """Loads under which the body looks as it does; ``let_go`` as of :class:`FingerLoad`."""
    return [
        FingerLoad(body.mesh.surface_nodes[nodes], forces, let_go=let_go)
        for nodes, forces in drawn_loads(snapshot)
    ]


def _close(made: Shape) -> None:
    earlier = made.notice
    made.close()
    if made.notice != earlier:
        # The press has ended, so there is no report; the table is computed again next time.
        print(f"palpate: {made.notice}")  # noqa: T201


def _close_made(making: Future[Shape]) -> None:
    if making.exception() is None:
        _close(making.result())
