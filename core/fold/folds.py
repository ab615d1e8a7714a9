"""A body that meets itself: its drawn surface is pressed out of itself by the least forces.

Where moved nodes are within the body (`native/src/fold`), each is pressed out, and the triangle
over it back, by a force along that triangle's normal that only pushes. Under these the surface
gives way by the body's own compliance, turned with it: the force on a node is turned back as the
surface is turned there, and what it does to others forth as these are. What is deep within is led
there from rest, step by step, so that it is pressed out on the side from which it came.

Nothing is kept from frame to frame: the same displacements always become the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Body, MovedSurface
from scipy.optimize import nnls

from ..body.soft_body import SoftBody

Array = NDArray[np.float64]

# Shares of the body's size: what is not seen, and how deep a node may be within to be found.
UNSEEN, DEEPEST = 2e-3, 0.08
# What is within by more than this share is led there, by at most such a share in a step, and in at
# most so many.
DEEP, STRIDE, MOST_STEPS = 1e-2, 3e-2, 12
# Rounds in each step, and in the last.
ROUNDS, LAST_ROUNDS = 2, 5
# At most so many nodes are pressed at once, apart by this share of the size.
MOST_PRESSED, APART = 24, 0.015
# Of the mean compliance of pushes, so that places that move as one share them.
HELD = 1e-3


@dataclass(frozen=True, eq=False)
class Within:
    """Nodes (k,) within the body, among the surface's.

    Attributes
    ----------
    corners : (k, 3), nodes of the triangles over them, among the surface's.
    alphas : (k, 3), area coordinates there.
    normals : (k, 3), outwards.
    depths : (k,), metres.
    """

    nodes: NDArray[np.int64]
    corners: NDArray[np.int64]
    alphas: Array
    normals: Array
    depths: Array

    @property
    def deepest(self) -> float:
        """Metres; 0 where nothing is within."""
        return float(self.depths.max(initial=0.0))

    def chosen(self, which: NDArray[np.int64] | NDArray[np.bool_]) -> Within:
        """Some of them."""
        return Within(
            self.nodes[which],
            self.corners[which],
            self.alphas[which],
            self.normals[which],
            self.depths[which],
        )

    def at(self, places: Array) -> Within:
        """The same nodes and triangles where the surface (n, 3) is now."""
        a, b, c = (places[self.corners[:, corner]] for corner in range(3))
        normals = np.cross(b - a, c - a)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.divide(normals, lengths, out=self.normals.copy(), where=lengths > 0.0)
        ways = np.einsum("kc,kci->ki", self.alphas, places[self.corners]) - places[self.nodes]
        depths = np.einsum("ki,ki->k", ways, normals)
        return Within(self.nodes, self.corners, self.alphas, normals, depths)

    def and_also(self, other: Within) -> Within:
        """These, and others."""
        return Within(
            np.concatenate([self.nodes, other.nodes]),
            np.concatenate([self.corners, other.corners]),
            np.concatenate([self.alphas, other.alphas]),
            np.concatenate([self.normals, other.normals]),
            np.concatenate([self.depths, other.depths]),
        )


@dataclass(frozen=True, eq=False)
class Folds:
    """The surface of a body, to be kept out of itself."""

    body: SoftBody

    def opened(self, displacements: Array) -> Array:
        """Displacements (n, 3) of the free surface nodes, metres, by which no node is within the
        body by what is seen, or less than it was.
        """
        farthest = float(np.abs(displacements).max(initial=0.0))
        if 2.0 * farthest <= UNSEEN * self.size:
            return displacements
        before = self.within(displacements)
        if before.deepest <= UNSEEN * self.size:
            return displacements
        steps = 1
        if before.deepest > DEEP * self.size:
            steps = min(MOST_STEPS, math.ceil(2.0 * farthest / (STRIDE * self.size)))
        added, pressed = np.zeros_like(displacements), before.chosen(np.zeros(0, dtype=np.int64))
        for step in range(1, steps + 1):
            rounds = LAST_ROUNDS if step == steps else ROUNDS
            moved = step / steps * displacements
            added, pressed = self._pressed_out(moved, added, pressed, rounds)
        opened = displacements + added
        return opened if self.within(opened).deepest < before.deepest else displacements

    def within(self, displacements: Array) -> Within:
        """Nodes that are within the body by these displacements (n, 3)."""
        found = self._surface.folds(self._moved(displacements), DEEPEST * self.size)
        nodes, triangles, alphas, normals, depths = found
        corners = self.body.mesh.surface_local_triangles[triangles]
        return Within(nodes, corners, alphas, normals, depths)

    @cached_property
    def size(self) -> float:
        """Diagonal of the body, metres."""
        return float(np.linalg.norm(np.ptp(self.body.mesh.nodes, axis=0)))

    @cached_property
    def _rest(self) -> Array:
        mesh = self.body.mesh
        rest: Array = mesh.nodes[mesh.surface_nodes]
        return rest

    @cached_property
    def _surface(self) -> MovedSurface:
        triangles = self.body.mesh.surface_local_triangles
        return MovedSurface(Body(self._rest, triangles, self.body.contact_blocks))

    @cached_property
    def _free(self) -> NDArray[np.int64]:
        """Number of each free node among the surface's."""
        return np.searchsorted(self.body.mesh.surface_nodes, self.body.compliance.free_surface)

    def _moved(self, displacements: Array) -> Array:
        moved = self._rest.copy()
        moved[self._free] += displacements
        return moved

    def _pressed_out(
        self, displacements: Array, added: Array, pressed: Within, rounds: int
    ) -> tuple[Array, Within]:
        """What forces add to displacements (n, 3) in some rounds, and where they press; beginning
        with what they added before.
        """
        best = math.inf, added, pressed
        for number in range(rounds + 1):
            found = self.within(displacements + added)
            if found.deepest < best[0]:
                best = found.deepest, added, pressed
            # What was pressed before is pressed anew once: it may have come off.
            is_known = number > 0 or not len(pressed.nodes)
            if number == rounds or (is_known and found.deepest <= UNSEEN * self.size):
                break
            here = self._moved(displacements + added)
            pressed = self._spread(pressed.at(here), found, here)
            added, pushes = self._answer(displacements, here, pressed)
            pressed = pressed.chosen(pushes > 0.0)
        return best[1], best[2]

    def _spread(self, pressed: Within, found: Within, places: Array) -> Within:
        """Those that are pressed, and the deepest of those found, none near another one."""
        taken = list(places[pressed.nodes])
        chosen: list[int] = []
        for number in np.argsort(-found.depths, kind="stable").tolist():
            if len(taken) >= MOST_PRESSED:
                break
            place = places[found.nodes[number]]
            away = np.linalg.norm(np.array(taken).reshape(-1, 3) - place, axis=1)
            if away.min(initial=np.inf) > APART * self.size:
                taken.append(place)
                chosen.append(number)
        return pressed.and_also(found.chosen(np.array(chosen, dtype=np.int64)))

    def _answer(
        self, displacements: Array, here: Array, pressed: Within
    ) -> tuple[Array, NDArray[np.float64]]:
        """What the least pushes (k,) add that keep nodes out, and these, at unit modulus."""
        turned = self._surface.turns(here).reshape(-1, 3, 3)
        loaded, ways = _ways(pressed)
        # Forces on the loaded nodes as the body at rest has them, a row of each push.
        at_rest = np.einsum("bji,kbj->kbi", turned[loaded], ways)
        size = 3 * len(loaded)
        blocks = self.body.surface_blocks(loaded, loaded).transpose(0, 2, 1, 3)
        flat = at_rest.reshape(-1, size)
        compliance = flat @ blocks.reshape(size, size) @ flat.T
        # By how much they would be within without any push, along the same normals.
        alone = self._moved(displacements)
        over = np.einsum("kc,kci->ki", pressed.alphas, alone[pressed.corners])
        depths = np.einsum("ki,ki->k", over - alone[pressed.nodes], pressed.normals)
        pushes = _least_pushes(compliance, depths)
        forces = np.einsum("k,kbi->bi", pushes, at_rest)
        added = self.body.deform(self.body.mesh.surface_nodes[loaded], forces, 1.0)
        return np.einsum("nij,nj->ni", turned[self._free], added), pushes


def _ways(pressed: Within) -> tuple[NDArray[np.int64], Array]:
    """Nodes (b,) that carry pushes, and of each push of one newton its forces on them (k, b, 3)."""
    all_nodes = np.column_stack([pressed.nodes, pressed.corners])
    loaded, places = np.unique(all_nodes, return_inverse=True)
    places = places.reshape(all_nodes.shape)
    shares = np.column_stack([np.ones(len(pressed.nodes)), -pressed.alphas])
    ways = np.zeros((len(pressed.nodes), len(loaded), 3))
    push = np.arange(len(pressed.nodes))
    for column in range(4):
        ways[push, places[:, column]] += shares[:, column, None] * pressed.normals
    return loaded, ways


def _least_pushes(compliance: Array, depths: Array) -> Array:
    """Pushes (k,) of least energy, none below zero, that open gaps of at least these depths."""
    held = HELD * float(np.diag(compliance).mean())
    factor = np.linalg.cholesky(compliance + held * np.eye(len(depths)))
    pushes, _ = nnls(factor.T, np.linalg.solve(factor, depths))
    found: Array = pushes
    return found
