"""Least forces that move patches of the surface as asked, and what all of the body does then.

The hand holds node i of a patch by a spring of compliance D_i: none in the core, which therefore
moves exactly as asked, and more and more to the rim, where it lets go. The forces are::

    (L_SS + D) F = g        u = L_S F

with L_SS the compliance between the nodes held, and g the motion. So the traction fades to nothing
at the rim, where that of a rigid patch would be infinite and draw an edge into the surface. Among
all forces with these springs they are those of least energy. D_i = R (1 / w_i - 1) / (a_i E) for a
firmness w_i, a share a_i of the surface and the radius R: the same hand on any mesh.

A body that nothing holds gives way to all that does not balance. So its forces do, R^T F = 0 with
its rigid motions R, and the hand goes along with what these leave free, ``(L_SS + D) F = g - R q``:
it draws a patch together or apart, and what moves or turns it as a whole takes no force.

As L is linear, each of the five fields of :mod:`.motions` is answered once; a frame is a sum.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from ..body.soft_body import SoftBody
from ..contact.near_field.surface_shape import node_areas
from ..errors import PalpateError
from .cells import cells_of
from .motions import FIELDS
from .patch import Grip, Patch, patch_of

Array = NDArray[np.float64]

# Unknown forces at most; nodes of larger patches share theirs by cells.
MOST_CELLS = 300
# Nodes between which the compliance is read at most.
MOST_READ = 2000
# Rows of blocks of the compliance read at once.
ROWS_TOGETHER = 200
# What is added to a diagonal, as a share of its mean, until the rounded compliance is definite.
RIDGES = (0.0, 1e-6, 1e-4, 1e-2)


@dataclass(frozen=True, eq=False)
class Answer:
    """What a motion of the patches takes and does.

    Attributes
    ----------
    displacements : float64 (n, 3), of the free surface nodes, metres.
    nodes : int64 (k,), nodes of the mesh that are held.
    forces : float64 (k, 3), on these, newton.
    force : float64 (3,), of the first grip on the body, newton.
    torque : of the first grip about its normal, newton metres.
    work : elastic energy in the body, joule.
    """

    displacements: Array
    nodes: NDArray[np.int64]
    forces: Array
    force: Array
    torque: float
    work: float


@dataclass(frozen=True, eq=False)
class HeldPatch:
    """Patches of one or several grips, which move together.

    Attributes
    ----------
    body : of the patches.
    nodes : int64 (k,), the nodes held, by their place among the free surface nodes.
    forces : float64 (k, 3, 5), on these at unit modulus, per unit of each field.
    displacements : float64 (n, 3, 5), of the free surface nodes, per unit of each field.
    first : float64 (k,), share of each force that is the first grip's.
    arms : float64 (k, 3), from the first grip's centre.
    axis : float64 (3,), its normal.
    """

    body: SoftBody
    nodes: NDArray[np.int64]
    forces: Array
    displacements: Array
    first: Array
    arms: Array
    axis: Array

    @classmethod
    def of(
        cls, body: SoftBody, grips: Sequence[Grip], normals: Array, *, is_held: bool | None = None
    ) -> HeldPatch:
        """Take hold of the body; ``normals`` (s, 3) are outward at its surface nodes. Where it
        ``is_held``, what does not balance is carried by pins, or by a hand that steadies it. None:
        as the body says.

        Raises
        ------
        PalpateError
            A place is pinned.
        """
        mesh = body.mesh
        patches = [patch_of(body, grip, normals) for grip in grips]
        held = np.unique(np.concatenate([patch.nodes for patch in patches]))
        weights = np.zeros((len(held), len(grips)))
        for number, patch in enumerate(patches):
            weights[np.searchsorted(held, patch.nodes), number] = patch.firmness
        shares = weights / weights.sum(axis=1, keepdims=True)
        places = mesh.nodes[mesh.surface_nodes[held]]
        # Where patches overlap their motions are mixed, so that mirrored ones meet in the middle.
        asked = sum(
            shares[:, number, None, None] * grip.fields(mesh, places)
            for number, grip in enumerate(grips)
        )
        nodes = body.free_index(mesh.surface_nodes[held])
        hold = _Hold(
            nodes, places, node_areas(mesh)[held], weights.max(axis=1), _radius(patches), asked
        )
        by_itself = body.in_hand or not body.is_free
        forces = hold.forces(body, is_held=by_itself if is_held is None else is_held)
        moved = [body.compliance.apply(forces[:, :, number], nodes) for number in range(FIELDS)]
        return cls(
            body,
            nodes,
            forces,
            np.stack(moved, axis=2),
            shares[:, 0],
            places - grips[0].centre(mesh),
            grips[0].normal,
        )

    def answer(self, shares: Array, young_modulus: float) -> Answer:
        """What a motion, as ``shares`` (5,) of the fields, takes and does."""
        displacements, forces = self.displacements @ shares, young_modulus * (self.forces @ shares)
        own = self.first[:, None] * forces
        return Answer(
            displacements,
            self.body.compliance.free_surface[self.nodes],
            forces,
            own.sum(axis=0),
            float(np.cross(self.arms, own).sum(axis=0) @ self.axis),
            0.5 * float((forces * displacements[self.nodes]).sum()),
        )


@dataclass(frozen=True, eq=False)
class _Hold:
    """Nodes (k,) held at ``places`` with ``areas`` and firmness, and the motion asked (k, 3, m)."""

    nodes: NDArray[np.int64]
    places: Array
    areas: Array
    firmness: Array
    radius: float
    asked: Array

    def forces(self, body: SoftBody, *, is_held: bool) -> Array:
        """Least forces (k, 3, m) at unit modulus."""
        cell = cells_of(self.places, MOST_CELLS)
        count = int(cell.max()) + 1
        # A cell's force is spread over its nodes by their areas, and its motion is their mean.
        spread = self.areas / np.bincount(cell, self.areas, count)[cell]
        compliance = _between_cells(body, self.nodes, cell, spread, count)
        springs = self.radius * (1.0 / self.firmness - 1.0) / self.areas
        every = np.repeat(np.bincount(cell, spread**2 * springs, count), 3)
        asked = np.zeros((count, 3, self.asked.shape[2]))
        np.add.at(asked, cell, spread[:, None, None] * self.asked)
        right = asked.reshape(3 * count, -1)
        matrix = compliance + np.diag(every)
        if not is_held:
            middles = np.zeros((count, 3))
            np.add.at(middles, cell, spread[:, None] * self.places)
            solved = _balanced(matrix, right, middles)
        else:
            solved = _solved(matrix, right)
        return spread[:, None, None] * solved.reshape(asked.shape)[cell]


def _between_cells(
    body: SoftBody, nodes: NDArray[np.int64], cell: NDArray[np.int64], spread: Array, count: int
) -> Array:
    """Compliance (3c, 3c) between the mean motions of cells and forces spread over them."""
    read, weight = _read(cell, spread, count)
    total = np.zeros((count, count, 3, 3))
    for first in range(0, len(read), ROWS_TOGETHER):
        rows = read[first : first + ROWS_TOGETHER]
        blocks = body.compliance.blocks(nodes[rows], nodes[read])
        blocks *= weight[rows, None, None, None] * weight[read][:, None, None]
        order = np.argsort(cell[read], kind="stable")
        starts = np.searchsorted(cell[read][order], np.arange(count))
        np.add.at(total, cell[rows], np.add.reduceat(blocks[:, order], starts, axis=1))
    matrix = total.transpose(0, 2, 1, 3).reshape(3 * count, 3 * count)
    return 0.5 * (matrix + matrix.T)


def _read(cell: NDArray[np.int64], spread: Array, count: int) -> tuple[NDArray[np.int64], Array]:
    """Nodes that stand for their cells, at least one each, and the shares (k,) they stand for."""
    each = max(1, MOST_READ // count)
    order = np.lexsort((-spread, cell))
    rank = np.arange(len(cell)) - np.searchsorted(cell[order], cell[order])
    read = np.sort(order[rank < each])
    weight = np.zeros(len(cell))
    weight[read] = spread[read]
    return read, weight / np.bincount(cell, weight, count)[cell]


def _balanced(matrix: Array, right: Array, places: Array) -> Array:
    """Least forces at ``places`` (c, 3) that neither move nor turn what they act on."""
    arms = places - places.mean(axis=0)
    motions = np.zeros((len(places), 3, 6))
    motions[:, :, :3] = np.eye(3)
    motions[:, :, 3:] = np.cross(np.eye(3)[None, :, :], arms[:, None, :]).transpose(0, 2, 1)
    rigid = motions.reshape(-1, 6)
    by_motion, forces = np.split(_solved(matrix, np.hstack([rigid, right])), [6], axis=1)
    # On a line no forces turn it, and any turn about that will do.
    left: Array = forces - by_motion @ np.linalg.pinv(rigid.T @ by_motion) @ (rigid.T @ forces)
    return left


def _solved(matrix: Array, right: Array) -> Array:
    mean = float(np.trace(matrix)) / len(matrix)
    for ridge in RIDGES:
        try:
            factor = cho_factor(matrix + ridge * mean * np.eye(len(matrix)), lower=True)
        except np.linalg.LinAlgError:
            continue
        solved: Array = cho_solve(factor, right)
        return solved
    raise PalpateError(
        "the compliance of the touched patch is not that of a body at rest; press Make Soft again"
    )


def _radius(patches: Sequence[Patch]) -> float:
    return float(np.mean([patch.radius for patch in patches]))
