"""Where a body that nothing holds is, as a whole, between what touches it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...compliance.free_body.inertia import RigidMotions
from ..solid.free_solid import FreeSolid
from .beside.held_aside import sliding
from .finger_load import FingerLoad, let_go, on_free_nodes

Array = NDArray[np.float64]

# Against a motion that no force feels, as a share of what is felt.
RIDGE = 1e-6
# A motion is loose where contacts resist it by more than this share of the one that they resist
# most: what the rim of a dent alone resists, friction holds. It gives then so many times as readily
# as the body where steps are chosen.
RESISTED, READILY = 0.1, 100.0


def met(
    modes: Array, moved: Array, linear: Array, forces: Array, only: Array | None = None
) -> Array:
    """Displacements (f, 3), moved as a whole until what is pressed is where it is linearly.

    By least squares, along the forces and weighed by them; a motion along which there is none stays
    out. A continuous function of all of them.

    Parameters
    ----------
    modes : (f, 3, 6), the nodes' rigid motions, orthonormal by mass.
    moved : (f, 3), without rigid motion.
    linear : (f, 3), the linear displacements.
    forces : (f, 3), under which they are.
    only : the direction (3,) in which alone a hand lets it go; none of one that is held.
    """
    if only is not None:
        modes = np.broadcast_to(only[:, None], (*moved.shape, 1))
    pressed = np.flatnonzero(forces.any(axis=1))
    if not len(pressed):
        return moved
    sizes = np.linalg.norm(forces[pressed], axis=1)
    along = forces[pressed] / sizes[:, None]
    rows = np.sqrt(sizes)[:, None] * np.einsum("ki,kiq->kq", along, modes[pressed])
    missed = np.sqrt(sizes) * np.einsum("ki,ki->k", along, (linear - moved)[pressed])
    square = rows.T @ rows
    scale = np.trace(square) / len(square)
    if not scale > 0.0:
        return moved
    shares = np.linalg.solve(square + RIDGE * scale * np.eye(len(square)), rows.T @ missed)
    return moved + modes @ shares


@dataclass(frozen=True, eq=False)
class Loose:
    """How a body goes as a whole between tools.

    Attributes
    ----------
    motions : rigid ones, those first which contacts hardly resist.
    gives : (6,), how readily each is followed, m/N at 1 Pa times m^3; none of what nothing resists.
    dead : (f, 3), the linear forces that no contact answers: loads of inertia, which are the weight
        where the body rests.
    """

    motions: RigidMotions
    gives: Array
    dead: Array

    @classmethod
    def of(cls, solid: FreeSolid, motions: RigidMotions, loads: Sequence[FingerLoad]) -> Loose:
        """Between the tools of ``loads``, of which each has one."""
        forces = on_free_nodes(solid, loads)
        balanced, linear = motions.balanced(forces), solid.linear(forces)
        square = np.zeros((6, 6))
        for load in loads:
            if load.by is None:
                continue
            own = on_free_nodes(solid, [load])
            pressed = np.flatnonzero(own.any(axis=1))
            there = solid.positions[pressed] + linear[pressed]
            _, normals = load.by.tool.distance(load.by.pose.to_tool(there))
            square += _resisted(
                own[pressed],
                normals @ load.by.pose.rotation.T,
                motions.of_nodes[pressed],
                load.friction,
            )
        only = let_go(loads)
        if only is not None:
            along = _shift(motions, only)
            square = along @ (along.T @ square @ along) @ along.T
        resisted, basis = np.linalg.eigh(square)
        turned = RigidMotions(motions.modes @ basis, motions.loads @ basis)
        size = float(np.linalg.norm(forces, axis=1).sum()) / 2.0
        yields = float((forces * linear).sum()) / (size * size)
        volume = 1.0 / float(np.square(motions.modes.reshape(-1, 3, 6)[0, :, :3]).sum() / 3.0)
        is_loose = resisted > RESISTED * resisted[-1]
        gives = np.where(is_loose, READILY * yields * volume, 0.0)
        return cls(turned, gives, balanced - forces)

    def compliance(self, free: NDArray[np.int64]) -> Array:
        """How far nodes (k,) of the free ones go with it under forces on these, (k, k, 3, 3)."""
        modes = self.motions.of_nodes[free]
        found: Array = np.einsum("aiq,q,bjq->abij", modes, self.gives, modes)
        return found


def _shift(motions: RigidMotions, way: Array) -> Array:
    """The shift along a direction (3,) as a share of each motion, (6, 1), of length one."""
    shares = motions.loads.reshape(-1, 3, 6).sum(axis=0).T @ way
    found: Array = shares[:, None] / max(float(np.linalg.norm(shares)), np.finfo(float).tiny)
    return found


def _resisted(forces: Array, out: Array, modes: Array, friction: float) -> Array:
    """How a tool's forces (k, 3) on nodes with its normals ``out`` (k, 3) resist motions (k, 3, 6)
    of these, (6, 6): along the normals, and aside as far as places stick.
    """
    push = np.maximum(np.einsum("ki,ki->k", out, forces), 0.0)
    rows = np.einsum("ki,kiq->kq", out, modes)
    found: Array = (push[:, None] * rows).T @ rows
    if friction > 0.0:
        holds = push * (1.0 - sliding(forces, out, friction))
        aside = modes - out[:, :, None] * rows[:, None, :]
        found = found + np.einsum("k,kip,kiq->pq", holds, aside, aside)
    return found
