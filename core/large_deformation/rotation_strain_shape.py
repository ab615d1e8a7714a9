"""The shape without a table: the linear displacement warped, then taken towards equilibrium."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..soft_body import SoftBody
from .by_component import Array
from .free_solid import FreeSolid
from .gradients import Gradients
from .relaxation import Relaxation
from .rotation_strain import RotationStrain
from .strain_energy import EnergyTerm, StrainEnergy

# Steps towards equilibrium for bodies of at most so many free nodes: what a frame of 60 Hz holds.
# Larger bodies are warped alone.
STEPS = ((600, 3), (1200, 2), (3000, 1))


class RotationStrainShape:
    """A :class:`.shapes.Shape`: warped, and relaxed by as many steps as a frame has time for.

    The body's stiffness is factored in the background; until that is done, :attr:`ready` is below
    1 and the shape is the linear one.

    Parameters
    ----------
    body : what is drawn.
    steps : towards equilibrium, every frame; None chooses by the number of free nodes.
    """

    def __init__(self, body: SoftBody, steps: int | None = None) -> None:
        self._body = body
        self._steps = steps
        self._share = 0.0
        self._is_ended = False
        worker = ThreadPoolExecutor(1, thread_name_prefix="palpate-rotation-strain")
        self._made: Future[_Made | None] = worker.submit(self._make)
        worker.shutdown(wait=False)

    @property
    def ready(self) -> float:
        """Share of the preparation that is done; the same for every place."""
        return self._share

    @property
    def notice(self) -> str:
        """Always empty: nothing is kept in files."""
        return ""

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
            The preparation failed: the pins do not hold the body.
        """
        made = self._made.result() if self._made.done() else None
        if made is None:
            return self._body.deform(nodes, nodal_forces, young_modulus)
        modulus = self._body.modulus(young_modulus)
        forces = made.solid.on_free_nodes(
            np.asarray(nodes).reshape(-1), np.asarray(nodal_forces).reshape(-1, 3) / modulus
        )
        steps = steps_in_a_frame(made.solid.node_count) if self._steps is None else self._steps
        moved = made.relaxation.relaxed(np.ascontiguousarray(forces.T), steps)
        return np.ascontiguousarray(moved[:, made.solid.surface].T)

    def wait_for(self, nodes: NDArray[np.int64]) -> None:  # noqa: ARG002 - of no single place
        """Return when the preparation is done; it is the same for all ``nodes``.

        Raises
        ------
        PalpateError
            It failed: the pins do not hold the body.
        """
        self._made.result()

    def close(self) -> None:
        """End the preparation at its next stage."""
        self._is_ended = True

    def _make(self) -> _Made | None:
        solid = FreeSolid.of(self._body)
        if self._goes_on(0.2):
            _ = solid.factor
        if self._goes_on(0.6):
            made = _Made(solid, relaxation(solid))
            if self._goes_on(1.0):
                return made
        return None

    def _goes_on(self, share: float) -> bool:
        if not self._is_ended:
            self._share = share
        return not self._is_ended


@dataclass(frozen=True, eq=False)
class _Made:
    solid: FreeSolid
    relaxation: Relaxation


def relaxation(solid: FreeSolid) -> Relaxation:
    """What is needed to relax a body's shape, ready to be used."""
    first, *others = solid.solid.terms
    coordinates = RotationStrain.of(first).factored()

    def solve(forces: Array) -> Array:
        moved: Array = solid.factor.solve(forces.T.ravel())
        return np.ascontiguousarray(moved.reshape(-1, 3).T)

    # The first term has the same domains: half the memory to read in every frame.
    terms = (
        EnergyTerm.of(first, coordinates.gradients),
        *(EnergyTerm.of(term, Gradients.of(term.gradients)) for term in others),
    )
    return Relaxation(coordinates, StrainEnergy(terms), solve)


def steps_in_a_frame(free_nodes: int) -> int:
    """How many steps towards equilibrium a frame has time for, for this many free nodes."""
    return next((steps for largest, steps in STEPS if free_nodes <= largest), 0)
