"""Rigid tools and floors around a body of a law that nothing holds.

As :mod:`.pressed_solid`, and as a body that nothing holds gives way as a whole, too: by a drag in
proportion to mass, tick after tick, until what the drag holds is next to nothing. So where it comes
to rest no force but those of what touches it acts, what may move without force stays where it was,
and of several rests it is the one that a body comes to by itself.

Walls may be rough: what presses one in a tick is held in the next against going aside from where it
was at rest, by friction times what it presses with. That is Coulomb's law as long as it slides one
way, as under tools that go straight in.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed.balance import Balance
from palpate.benchmarks.measuring.shape.pressed.contact import (
    AllOf,
    Beside,
    Contact,
    Held,
    Penalty,
    Rubbed,
    Spread,
)
from palpate.benchmarks.measuring.shape.pressed.pressed_solid import (
    PENALTIES,
    TouchedSurface,
    touched_surface,
    usual_edge,
)
from palpate.benchmarks.measuring.shape.pressed.pressers import Presser, Wall
from palpate.core.body.soft_body import SoftBody
from palpate.core.shape.solid.free_solid import FreeSolid

Array = NDArray[np.float64]

# The drag in a tick as a spring of the whole body, per pascal and metre of its size: some hundred
# times softer than what presses. And that which tells a rest from what the body leaves.
DRAG, LEAST_DRAG = 1e-3, 1e-6
# More of it in the first tick, so that a body does not leap over the rest that it would come to.
FIRST_DRAG = 10.0 * DRAG
# What the drag may hold at rest, over the largest force, and over that times the body's size.
HELD_BY_DRAG = 1e-4
MOST_TICKS = 200
# How far a rough wall lets places go aside before they slide, over the edge.
SLACK = 2e-3
# What Newton's method leaves; the drag is soft, so it must be little.
RESIDUAL_SHARE = 1e-6


@dataclass(frozen=True, eq=False)
class Lying:
    """The body among what touches it; at unit modulus.

    Attributes
    ----------
    displacements : (N, 3) of all nodes, in the world, metres.
    forces : (k, 3) on the body, of everything that touches it, in its order.
    places : how many places the first presses; fewer where few carry most of it.
    held : what the drag still holds, its force and torque over the largest force and the size; and
        what friction still changes.
    ticks : until there.
    is_stable : whether the energy is least there; else it is an equilibrium that a body leaves, or
        none that it came to.
    """

    displacements: Array
    forces: Array
    places: float
    held: float
    ticks: int
    is_stable: bool


@dataclass(frozen=True, eq=False)
class LyingSolid:
    """A body without pins, to be pressed."""

    body: SoftBody

    @cached_property
    def solid(self) -> FreeSolid:
        """The material on all nodes."""
        return FreeSolid.of(self.body)

    def among(self, steps: Sequence[Sequence[Presser]]) -> Iterator[Lying]:
        """The body among one set of tools and floors after another, each from where the last one
        left it.

        Raises
        ------
        ArithmeticError
            Newton's method does not come to an end, or the body slips out from between them.
        """
        moved = np.zeros_like(self.solid.positions)
        firm = PENALTIES[-1] / self.edge * self._surface.shares
        for tools in steps:
            contacts = tuple(Penalty(tool, firm) for tool in tools)
            found = self._at_rest(contacts, self._ticked(contacts, moved, FIRST_DRAG))
            moved = found.displacements
            yield found

    @cached_property
    def edge(self) -> float:
        """Of a usual triangle, metres."""
        return usual_edge(self.solid, self.body.mesh.surface_triangles)

    def _at_rest(self, contacts: tuple[Penalty, ...], moved: Array) -> Lying:
        rubbed = self._rubbed(contacts, moved)
        ticks, held = 0, inf
        while held > HELD_BY_DRAG and ticks < MOST_TICKS:
            ticks += 1
            before, moved = moved, self._ticked(contacts, moved, DRAG)
            pushes = [one.pushes(self._surface.spread.places(moved)) for one in contacts]
            forces = np.array([one.forces.sum(axis=0) for one in pushes])
            if not forces.any():
                raise ArithmeticError("nothing touches the body any more")
            last, rubbed = rubbed, self._rubbed(contacts, moved)
            changed = sum(
                float(np.abs(new.most - old.most).sum())
                for new, old in zip(rubbed, last, strict=True)
            )
            held = changed + self._held(before - moved, moved)
            held /= float(np.linalg.norm(forces, axis=1).max())
        free = self._dragged([*contacts, *rubbed], LEAST_DRAG, moved)
        is_stable = held <= HELD_BY_DRAG and self._balance.is_stable(
            free.pushes(self._spread.places(moved)), moved
        )
        return Lying(moved, forces, pushes[0].places, held, ticks, is_stable)

    def _ticked(self, contacts: tuple[Penalty, ...], moved: Array, drag: float) -> Array:
        """Where the body is after a tick."""
        touching: list[Contact] = [*contacts, *self._rubbed(contacts, moved)]
        return self._balance.at_rest(self._dragged(touching, drag, moved), moved)

    def _dragged(self, contacts: Sequence[Contact], by: float, before: Array) -> Contact:
        drag = Held(self.solid.positions + before, by * self._masses)
        return Beside(len(self._surface.shares), AllOf(tuple(contacts)), drag)

    def _rubbed(self, contacts: tuple[Penalty, ...], moved: Array) -> tuple[Rubbed, ...]:
        """By what presses rough walls at displacements (N, 3)."""
        spread = self._surface.spread
        places, rest = spread.places(moved), spread.places(np.zeros_like(moved))
        found = []
        for contact in contacts:
            wall = contact.tool
            if isinstance(wall, Wall) and wall.friction > 0.0:
                most = wall.friction * np.linalg.norm(contact.pushes(places).forces, axis=1)
                if not moved.any():
                    # Nothing presses yet: what touches stays where it is.
                    touches = np.abs(wall.depths(places).depth) < SLACK * self.edge
                    most = wall.friction * touches * self._surface.shares
                found.append(Rubbed(rest, wall.outward, most, SLACK * self.edge))
        return tuple(found)

    def _held(self, missed: Array, moved: Array) -> float:
        """Force of the drag, and torque over the body's size, whichever is more; newton."""
        forces = DRAG * self._masses[:, None] * missed
        places = self.solid.positions + moved
        torque = np.cross(places - places.mean(axis=0), forces).sum(axis=0) / self._size
        return float(max(np.linalg.norm(forces.sum(axis=0)), np.linalg.norm(torque)))

    @property
    def _size(self) -> float:
        return float(np.ptp(self.solid.positions, axis=0).max())

    @cached_property
    def _masses(self) -> Array:
        """Of the nodes, (N,), so that all together are the body's size, metres."""
        volumes = self.body.inertia.node_volumes
        masses: Array = self._size * volumes / volumes.sum()
        return masses

    @property
    def _balance(self) -> Balance:
        return Balance(self._spread, RESIDUAL_SHARE)

    @cached_property
    def _surface(self) -> TouchedSurface:
        return touched_surface(self.solid, self.body.mesh.surface_triangles)

    @cached_property
    def _spread(self) -> Spread:
        """The surface's places, and all nodes."""
        return self._surface.spread.and_then(Spread.of_nodes(self.solid.free, self.solid))
