"""Shape and force of loads that change while they are looked for in the background.

A press that goes on by hand cannot wait for its rest. What was found last tells what to add to the
linear displacement in the meantime: it begins with the square of the load, as the energy does.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from .meeting import settled
from .rotation_strain.finger_load import FingerLoad, alike, joined
from .rotation_strain.pressed import Firmness
from .shapes import Shape, pressed_by

Array = NDArray[np.float64]
Loads: TypeAlias = Sequence[FingerLoad]


@dataclass(frozen=True, eq=False)
class Shaped:
    """A body under loads of a linear one.

    Attributes
    ----------
    displacements : (n, 3) of the free surface nodes, metres.
    share : of the linear forces that is felt.
    """

    displacements: Array
    share: float = 1.0


@dataclass(frozen=True, eq=False)
class _Found:
    """What was found of a press that held ``energy``, joule: what it adds to the linear one."""

    added: Array
    energy: float
    firmness: Firmness


@dataclass(eq=False)
class FoundBehind:
    """A body whose loads change; ``news`` says whether more is known than was asked for last."""

    body: SoftBody
    shape: Shape
    young_modulus: float
    _worker: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, "palpate-behind")
    )
    _finding: Future[_Found] | None = None
    _looked: Loads = ()
    _found: _Found | None = None

    @property
    def news(self) -> bool:
        """Whether a search has ended that no answer knows of yet."""
        return self._finding is not None and self._finding.done()

    def now(self, loads: Loads) -> Shaped:
        """The body as it is known now, at once; a search begins where loads are new.

        Raises
        ------
        PalpateError
            It cannot be computed.
        """
        linear, energy = self._linear(loads)
        if self._finding is not None and self._finding.done():
            self._found, self._finding = self._finding.result(), None
        if self._finding is None and energy > 0.0 and not alike(loads, self._looked):
            self._looked = loads
            self._finding = self._worker.submit(self._find, loads)
        if self._found is None or not energy > 0.0:
            return Shaped(linear)
        depth = math.sqrt(energy / self._found.energy)
        # Beyond what was looked at it is not trusted to go on with the square.
        moved = linear + depth * min(depth, 1.0) * self._found.added
        return Shaped(moved, self._found.firmness.at(energy / self.young_modulus))

    def at_rest(self, loads: Loads) -> Shaped:
        """The body at rest; waits for it.

        Raises
        ------
        PalpateError
            It cannot be computed.
        """
        linear, energy = self._linear(loads)
        if not energy > 0.0:
            return Shaped(linear)
        found = self._find(loads)
        return Shaped(linear + found.added, found.firmness.deepest)

    def close(self) -> None:
        """End; does not wait."""
        self._worker.shutdown(wait=False, cancel_futures=True)

    def _linear(self, loads: Loads) -> tuple[Array, float]:
        nodes, forces = joined(loads)
        moved = self.body.deform(nodes, forces, self.young_modulus)
        places = self.body.free_index(nodes)
        free = places >= 0
        return moved, 0.5 * float((forces[free] * moved[places[free]]).sum())

    def _find(self, loads: Loads) -> _Found:
        self.shape.wait_for(np.unique(joined(loads)[0]))
        linear, energy = self._linear(loads)
        pressed = pressed_by(self.shape, loads, self.young_modulus)
        moved = pressed.displacements
        if moved is None:
            # What holds many nodes cannot be met by changing its forces: linear, then.
            holds = any(one.sticks for one in loads)
            met = None if holds else settled(self.body, self.shape, loads, self.young_modulus)
            moved = linear if met is None else met.displacements
        return _Found(moved - linear, energy, pressed.firmness)
