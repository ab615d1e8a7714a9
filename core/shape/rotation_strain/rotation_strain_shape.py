"""The shape without a table: the linear displacement warped, then taken towards equilibrium.

Small bodies are computed on their own nodes, larger ones by :mod:`.two_levels`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from threading import Lock
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...errors import PalpateError
from ..solid.free_solid import FreeSolid
from .finger_load import FingerLoad, alike, are_near
from .firmness import FirmBody
from .lying import met
from .pressed import LINEAR, Found, Pressed
from .relaxation import Relaxation, relaxation
from .two_levels import TwoLevels

Array = NDArray[np.float64]
# Displacements (n, 3) under forces (k, 3) on nodes (k,), at unit modulus, of one that is let go.
Draw: TypeAlias = Callable[[NDArray[np.int64], Array, Array | None], Array]

# Forces that change by no more than this share are those of a press that rests.
STILL = 1e-6


@dataclass(frozen=True)
class FramePlan:
    """Plan of the work in every frame.

    Attributes
    ----------
    steps : towards equilibrium.
    lattice_nodes : at most so many carry what is not linear; 0 where the body's own nodes do.
    """

    steps: int
    lattice_nodes: int = 0


# For bodies of at most so many free nodes, and for all others: what a frame of 60 Hz holds.
PLANS = ((600, FramePlan(4)), (1200, FramePlan(3)), (2000, FramePlan(2)))
PLAN_OF_LARGE = FramePlan(2, 1200)
# To so many free nodes it is felt, too, and comes to rest where somebody waits: on its own nodes.
MOST_FELT = 5000


def frame_plan(free_nodes: int) -> FramePlan:
    """Work that a frame has time for, by number of free nodes."""
    return next((plan for largest, plan in PLANS if free_nodes <= largest), PLAN_OF_LARGE)


class RotationStrainShape:
    """A :class:`.shapes.Shape`: warped, and relaxed by as many steps as a frame has time for.

    It is prepared in the background; until that is done, :attr:`ready` is below 1 and the shape is
    the linear one.

    Parameters
    ----------
    body : what is drawn.
    plan : of every frame; None chooses by the number of free nodes.
    """

    def __init__(self, body: SoftBody, plan: FramePlan | None = None) -> None:
        self._body = body
        free_nodes = len(body.mesh.nodes) - len(body.fixed)
        self._plan = frame_plan(free_nodes) if plan is None else plan
        self._share = 0.0
        self._is_ended = False
        self._pressing = Lock()
        self._last: tuple[Sequence[FingerLoad], float, Pressed] | None = None
        # Of so many that touch the last press, from which a near one goes on.
        self._found: dict[int, tuple[Sequence[FingerLoad], Found | None]] = {}
        worker = ThreadPoolExecutor(1, thread_name_prefix="palpate-rotation-strain")
        self._made: Future[_Made | None] = worker.submit(self._make)
        worker.shutdown(wait=False)

    @property
    def ready(self) -> float:
        """Share of the preparation that is done; the same for every place."""
        done = self._made.done() and self._made.exception() is None
        return 1.0 if done and self._made.result() is not None else self._share

    @property
    def notice(self) -> str:
        """Always empty: nothing is kept in files."""
        return ""

    def displacements(
        self,
        nodes: NDArray[np.int64],
        nodal_forces: Array,
        young_modulus: float | None = None,
        let_go: Array | None = None,
    ) -> Array:
        """Displacements (n, 3) of the free surface nodes, metres; see :class:`.shapes.Shape`.

        Raises
        ------
        PalpateError
            The preparation failed: the pins do not hold the body.
        """
        made = self._made.result() if self._made.done() else None
        if made is None:
            return self._body.deform(nodes, nodal_forces, young_modulus)
        modulus = self._body.modulus(young_modulus)
        forces = np.asarray(nodal_forces, dtype=np.float64).reshape(-1, 3) / modulus
        return made.draw(np.asarray(nodes).reshape(-1), forces, let_go)

    def pressed(
        self, loads: Sequence[FingerLoad], young_modulus: float, ahead: float = 1.0
    ) -> Pressed:
        """How firmly it presses back, see :func:`.shapes.pressed_by`, and where its free surface
        comes to rest; linear and nowhere until prepared, and for a body of too many nodes.
        """
        made = self._made.result() if self._made.done() else None
        if made is None or made.firm is None:
            return LINEAR
        unit = [load.times(1.0 / young_modulus) for load in loads]
        with self._pressing:
            # What is drawn and what is felt are asked for one after the other.
            known = self._last
            if known is None or known[1] != ahead or not alike(known[0], unit):
                near, found = self._found.get(len(unit), ((), None))
                before = found if are_near(near, unit) else None
                pressed = made.firm.pressed(unit, ahead, before)
                if pressed.displacements is not None:
                    seen = pressed.displacements[made.firm.solid.surface]
                    pressed = replace(pressed, displacements=seen)
                self._last = known = unit, ahead, pressed
                self._found[len(unit)] = unit, pressed.found
            return known[2]

    def known(self, loads: Sequence[FingerLoad], young_modulus: float) -> Pressed:
        """The same where it has been found for this very press, at once; else that of a linear
        body.
        """
        known = self._last
        unit = [load.times(1.0 / young_modulus) for load in loads]
        if known is None or known[1] != 1.0 or not alike(known[0], unit, STILL):
            return LINEAR
        return known[2]

    def wait_for(self, nodes: NDArray[np.int64]) -> None:  # noqa: ARG002 - of no single place
        """Return when the preparation is done; it is the same for all ``nodes``.

        Raises
        ------
        PalpateError
            It failed, because the pins do not hold the body, or the shape was closed before.
        """
        if self._made.result() is None:
            raise PalpateError("real: this shape was closed before it was prepared; make a new one")

    def close(self) -> None:
        """End the preparation at its next stage."""
        self._is_ended = True

    def _make(self) -> _Made | None:
        """Stage by stage, between which :meth:`close` is heeded."""
        steps, draw = self._plan.steps, None
        if self._plan.lattice_nodes:
            levels = TwoLevels.of(self._body, self._plan.lattice_nodes)
            draw = _on_lattice(self._body, levels, steps)
            if len(self._body.mesh.nodes) - len(self._body.fixed) > MOST_FELT:
                return None if self._is_ended else _Made(draw)
        solid = FreeSolid.of(self._body)
        if self._goes_on(0.2):
            _ = solid.factor
        if not self._goes_on(0.6):
            return None
        relaxing = relaxation(solid)
        firm = FirmBody(self._body, solid, relaxing.another())
        if self._is_ended:
            return None
        return _Made(draw or _on_own_nodes(firm, relaxing, steps), firm)

    def _goes_on(self, share: float) -> bool:
        if not self._is_ended:
            self._share = share
        return not self._is_ended


@dataclass(frozen=True, eq=False)
class _Made:
    """How it is drawn, and what tells the force."""

    draw: Draw
    firm: FirmBody | None = None


def _on_own_nodes(firm: FirmBody, relaxing: Relaxation, steps: int) -> Draw:
    solid, seen = firm.solid, firm.solid.surface

    def draw(nodes: NDArray[np.int64], forces: Array, let_go: Array | None) -> Array:
        held = solid.on_free_nodes(nodes, forces)
        moved = relaxing.relaxed(held, steps)[seen]
        if solid.motions is None:
            return moved
        linear = firm.body.deform(nodes, forces, 1.0)
        return met(solid.motions.of_nodes[seen], moved, linear, held[seen], let_go)

    return draw


def _on_lattice(body: SoftBody, levels: TwoLevels, steps: int) -> Draw:
    def draw(nodes: NDArray[np.int64], forces: Array, let_go: Array | None) -> Array:
        linear = body.deform(nodes, forces, 1.0)
        places = body.free_index(nodes)
        free = places >= 0
        return levels.corrected(linear, places[free], forces[free], steps, let_go)

    return draw
