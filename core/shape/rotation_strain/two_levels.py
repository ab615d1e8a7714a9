"""A large body's shape: linear as finely as it is, corrected as coarsely as the correction is.

The linear displacement u of the surface is exact and cheap, from the compliance. What a large
deformation adds to it varies smoothly, so it is found on a :class:`.coarse_solid.CoarseSolid`:

- v, the lattice's displacement that comes nearest to u and is in equilibrium inside;
- a load under which the lattice is at v where it stays linear: that of the body, in the share of
  the two stiffnesses, and what is left, which turns along with the lattice (a lattice is too stiff
  in one place and too soft in another, and forces that make up for it must not bend it);
- w, the lattice's large deformation under this load (:mod:`.relaxation`);
- u + P (w - v) is drawn, P the interpolation from the lattice.

To first order in the forces w is v, and nothing is added. What is finer than the lattice stays
linear.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ...body.soft_body import SoftBody
from ...compliance.elimination.cholesky import CholeskyFactor, RepeatedElimination
from ...compliance.free_body.hold import held
from ...compliance.free_body.inertia import Inertia, RigidMotions
from ...law.of_material import law_of
from ...stiffness.assembly import lame_parameters
from ...stiffness.held_pins import free_or_pinned
from ..lattice.coarse_solid import CoarseSolid, by_axes, spring_of_each
from ..lattice.lattice import Lattice, lattice_of
from .lying import met
from .relaxation import Relaxation

Array = NDArray[np.float64]

# How stiffly the lattice follows the surface, in shear moduli times edge for each part.
FOLLOWING = 1.0
# Bounds of the share in which a lattice is stiffer than its body, as far as it counts.
STIFFER = (0.25, 4.0)


@dataclass(frozen=True, eq=False)
class TwoLevels:
    """Two-level correction of linear displacements of a body's free surface.

    Attributes
    ----------
    surface : csr (n, c), P: displacements of the lattice's nodes taken to the free surface.
    following : csr (c, n), its transpose times the springs by which the lattice follows.
    follow : factor by which the lattice's displacements come from forces on it.
    relaxation : of the lattice.
    modes : (n, 3, 6), rigid motions of the free surface of a body without pins.
    """

    surface: csr_array
    following: csr_array
    follow: CholeskyFactor
    relaxation: Relaxation
    modes: Array | None = None

    @classmethod
    def of(cls, body: SoftBody, most_nodes: int) -> TwoLevels:
        """For a body, with a lattice of at most so many nodes.

        Raises
        ------
        PalpateError
            The pins do not hold the body, or it is of several pieces without any.
        """
        free_or_pinned(body.mesh, body.fixed)
        mesh, seen = body.mesh, body.compliance.free_surface
        lattice = lattice_of(mesh, most_nodes)
        law = law_of(body.poisson_ratio, body.law)
        coarse = CoarseSolid.of(
            lattice, mesh, body.fixed, body.poisson_ratio, body.young_scale, law
        )
        surface = lattice.interpolation(mesh.nodes[seen], lattice.node_parts[seen])
        _, shear = lame_parameters(1.0, body.poisson_ratio)
        stiffness = FOLLOWING * shear * lattice.edge * coarse.part_modulus
        springs = spring_of_each(lattice, seen, stiffness)
        following = csr_array(surface.T).multiply(springs).tocsr()
        at_rest = coarse.stiffness
        followed = _factor(at_rest + by_axes(csr_array(following @ surface)), lattice.positions)
        motions = _motions(body, lattice) if body.is_free else None
        at_hold = at_rest if motions is None else held(lattice.positions, at_rest)
        solved = _factor(at_hold, lattice.positions)
        relaxation = Relaxation.of(
            coarse.solid.terms, coarse.solid.law, solved, lattice.positions, coarse.springs, motions
        )
        modes = body.inertia.modes(mesh.nodes[seen]) if body.is_free else None
        return cls(surface, following, followed, relaxation, modes)

    def corrected(
        self,
        linear: NDArray[np.float64],
        places: NDArray[np.int64],
        forces: NDArray[np.float64],
        steps: int,
        only: NDArray[np.float64] | None = None,
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) of the free surface from linear ones (n, 3).

        Parameters
        ----------
        linear : what ``forces`` cause where the body stays linear.
        places, forces : (k,), (k, 3), on which of the free surface nodes, at unit modulus.
        steps : towards equilibrium.
        only : the direction (3,) in which alone a hand lets it go.
        """
        load = self.surface[places].T @ forces
        motions = self.relaxation.motions
        if motions is not None:
            load = motions.balanced(load)
        v = self.follow.solve((load + self.following @ linear).ravel()).reshape(-1, 3)
        keeping = load + self.following @ (linear - self.surface @ v)
        dead = _stiffer(keeping, load, v) * load
        if motions is not None:
            v = motions.still(v)
        w = self.relaxation.relaxed_from(v, dead, steps, keeping - dead)
        moved: Array = linear + self.surface @ (w - v)
        if self.modes is None:
            return moved
        pressed = np.zeros_like(linear)
        np.add.at(pressed, places, forces)
        return met(self.modes, moved, linear, pressed, only)


def _motions(body: SoftBody, lattice: Lattice) -> RigidMotions:
    """Rigid motions of a lattice whose nodes carry the mass of the body's."""
    mesh = body.mesh
    carried = lattice.interpolation(mesh.nodes, lattice.node_parts)
    masses = np.maximum(carried.T @ body.inertia.node_volumes, 0.0)
    return RigidMotions.of(Inertia.at(lattice.positions, masses), lattice.positions)


def _stiffer(held: Array, load: Array, moved: Array) -> float:
    """Stiffness of a lattice relative to its body: work of its constraints over the load's."""
    least, most = STIFFER
    own, all_work = (float(np.vdot(forces, moved)) for forces in (load, held))
    if all_work >= most * own:
        return most
    return max(all_work / own, least)


def _factor(matrix: csr_array, positions: NDArray[np.float64]) -> CholeskyFactor:
    blocks = matrix.tobsr((3, 3))
    rows = np.repeat(np.arange(len(positions)), np.diff(blocks.indptr))
    elimination = RepeatedElimination.of(rows, blocks.indices.astype(np.int64), positions)
    return elimination.factor(blocks.data)
