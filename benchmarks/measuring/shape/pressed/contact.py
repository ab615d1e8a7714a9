"""What presses places of a body: tools by a penalty, springs; energies, forces and stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed.pressers import Presser
from palpate.core.shape.solid.free_solid import FreeSolid

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Pushes:
    """What presses: energy in joule, forces (p, 3) on the places, and what resists, (p, 3, 3).

    ``convex`` (p, 3, 3) is that without what lowers the energy at once.
    """

    energy: float
    forces: Array
    stiffness: Array
    convex: Array

    @property
    def usual(self) -> float:
        """The mean of what presses a place, each weighed by itself; newton."""
        sizes = np.linalg.norm(self.forces, axis=1)
        return float((sizes * sizes).sum() / max(sizes.sum(), 1e-300))

    @property
    def places(self) -> float:
        """How many places press; fewer where few carry most of it."""
        sizes = np.linalg.norm(self.forces, axis=1)
        return float(sizes.sum() ** 2 / max((sizes * sizes).sum(), 1e-300))


class Contact(Protocol):
    """What presses places."""

    def pushes(self, places: Array) -> Pushes:
        """Of places (p, 3) where they are now, metres."""
        ...


@dataclass(frozen=True, eq=False)
class Penalty:
    """A tool, with as much force for every metre that a place is within, (p,)."""

    tool: Presser
    stiffness: Array

    def pushes(self, places: Array) -> Pushes:
        """See :class:`Contact`."""
        met = self.tool.depths(places)
        pressed = self.stiffness * np.maximum(met.depth, 0.0)
        firm = np.where(met.depth > 0.0, self.stiffness, 0.0)
        convex = np.einsum("p,pi,pj->pij", firm, met.normals, met.normals)
        stiffness = convex - pressed[:, None, None] * met.bends
        energy = 0.5 * float(pressed @ met.depth)
        return Pushes(energy, pressed[:, None] * met.normals, stiffness, convex)


@dataclass(frozen=True, eq=False)
class Held:
    """Springs, (p,) each, that hold places at ``goal`` (p, 3)."""

    goal: Array
    stiffness: Array

    def pushes(self, places: Array) -> Pushes:
        """See :class:`Contact`."""
        missed = self.goal - places
        forces = self.stiffness[:, None] * missed
        firm = self.stiffness[:, None, None] * np.eye(3)
        return Pushes(0.5 * float((forces * missed).sum()), forces, firm, firm)


@dataclass(frozen=True, eq=False)
class Rubbed:
    """Places held against going aside from ``goal`` (p, 3), across ``normal`` (3,), with no more
    force than ``most`` (p,), newton, which is reached at a way of ``slack`` metres.
    """

    goal: Array
    normal: Array
    most: Array
    slack: float

    def pushes(self, places: Array) -> Pushes:
        """See :class:`Contact`."""
        across = np.eye(3) - np.outer(self.normal, self.normal)
        missed = (self.goal - places) @ across
        way = np.linalg.norm(missed, axis=1)
        slides = way > self.slack
        energy = np.where(slides, way - 0.5 * self.slack, 0.5 * way * way / self.slack)
        # As of a spring that becomes softer so that its force stays.
        firm = self.most / np.maximum(way, self.slack)
        along = missed / np.maximum(way, 1e-300)[:, None] * slides[:, None]
        turns = across - along[:, :, None] * along[:, None, :]
        stiffness = firm[:, None, None] * turns
        return Pushes(float(self.most @ energy), firm[:, None] * missed, stiffness, stiffness)


@dataclass(frozen=True, eq=False)
class AllOf:
    """Several that press the same places."""

    parts: tuple[Contact, ...]

    def pushes(self, places: Array) -> Pushes:
        """See :class:`Contact`."""
        each = [part.pushes(places) for part in self.parts]
        return Pushes(
            sum(one.energy for one in each),
            sum((one.forces for one in each), np.zeros((len(places), 3))),
            sum((one.stiffness for one in each), np.zeros((len(places), 3, 3))),
            sum((one.convex for one in each), np.zeros((len(places), 3, 3))),
        )


@dataclass(frozen=True, eq=False)
class Beside:
    """What presses the first ``count`` places, and what presses the others."""

    count: int
    first: Contact
    others: Contact

    def pushes(self, places: Array) -> Pushes:
        """See :class:`Contact`."""
        one = self.first.pushes(places[: self.count])
        two = self.others.pushes(places[self.count :])
        return Pushes(
            one.energy + two.energy,
            np.concatenate([one.forces, two.forces]),
            np.concatenate([one.stiffness, two.stiffness]),
            np.concatenate([one.convex, two.convex]),
        )


@dataclass(frozen=True, eq=False)
class Spread:
    """Places (p,) in triangles: corners (p, 3) by places in ``solid.free``, area coordinates."""

    corners: NDArray[np.int64]
    alphas: Array
    solid: FreeSolid

    @classmethod
    def of_nodes(cls, nodes: NDArray[np.int64], solid: FreeSolid) -> Spread:
        """Nodes (k,), by their places in ``solid.free``."""
        corners = np.repeat(nodes[:, None], 3, axis=1)
        return cls(corners, np.tile([1.0, 0.0, 0.0], (len(nodes), 1)), solid)

    def and_then(self, others: Spread) -> Spread:
        """These places, followed by ``others``."""
        corners = np.concatenate([self.corners, others.corners])
        return Spread(corners, np.concatenate([self.alphas, others.alphas]), self.solid)

    def places(self, moved: Array) -> Array:
        """Where they are, (p, 3), at displacements (f, 3)."""
        corners = self.solid.positions[self.corners] + moved[self.corners]
        return np.asarray(np.einsum("pa,pai->pi", self.alphas, corners))

    def on_nodes(self, forces: Array) -> Array:
        """Forces (p, 3) as forces on the nodes, (f, 3)."""
        found = np.zeros_like(self.solid.positions)
        np.add.at(found, self.corners, self.alphas[:, :, None] * forces[:, None, :])
        return found

    def blocks(self, stiffness: Array) -> Array:
        """Stiffness (p, 3, 3) of the places as blocks (m, 3, 3) of the body's tangents."""
        pattern = self.solid.solid.pattern
        found = np.zeros((len(pattern.rows), 3, 3))
        acts = stiffness.any(axis=(1, 2))
        added = np.einsum("pa,pb,pij->pabij", self.alphas[acts], self.alphas[acts], stiffness[acts])
        np.add.at(found, self._pairs[acts], added)
        return found

    @cached_property
    def _pairs(self) -> NDArray[np.int64]:
        """Where each two corners of a place stand in the tangents' pattern, (p, 3, 3)."""
        pattern, count = self.solid.solid.pattern, self.solid.node_count
        keys = pattern.rows * count + pattern.columns
        return np.searchsorted(keys, self.corners[:, :, None] * count + self.corners[:, None, :])
