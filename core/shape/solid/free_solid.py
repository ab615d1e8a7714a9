"""A body ready for solves: what its free nodes feel, and the factored stiffness.

One without pins is solved for the loads of inertia that make forces balance, as its compliance is
(:mod:`...compliance.free_body`), and its displacements have no rigid motion.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ...body.soft_body import SoftBody
from ...compliance.elimination.cholesky import (
    CholeskyFactor,
    NotPositiveDefiniteError,
    RepeatedElimination,
)
from ...compliance.free_body.hold import hold
from ...compliance.free_body.inertia import RigidMotions
from ...errors import PalpateError
from ...law.law import Law
from ...law.of_material import law_of
from ...stiffness.held_pins import free_or_pinned
from .solid import Solid, solid
from .strain_term import StrainTerm


@dataclass(frozen=True, eq=False)
class FreeSolid:
    """The solid of a body whose pinned nodes stay, at unit modulus; arrays are of free nodes only.

    For another Young's modulus E, divide forces by E; displacements are the same for the same F/E.

    Attributes
    ----------
    solid : on the free nodes; numbered as in ``free``.
    free : int64 (f,), node numbers of the mesh, ascending.
    surface : int64 (n,), the places in ``free`` of ``body.compliance.free_surface``.
    positions : (f, 3), at rest, metres.
    motions : rigid ones of a body without pins; None of others.
    """

    solid: Solid
    free: NDArray[np.int64]
    surface: NDArray[np.int64]
    positions: NDArray[np.float64]
    motions: RigidMotions | None = None

    @classmethod
    def of(cls, body: SoftBody, law: Law | None = None) -> FreeSolid:
        """The solid of a body, with the strains its compliance was made with.

        ``law`` is that of its material, unless another is given.

        Raises
        ------
        PalpateError
            As :func:`.solid.solid`, and where the pins do not hold the body.
        """
        mesh = body.mesh
        free_or_pinned(mesh, body.fixed)
        own_law = law_of(body.poisson_ratio, body.law) if law is None else law
        whole = solid(mesh, body.poisson_ratio, own_law, body.formulation, body.young_scale)
        free = np.setdiff1d(np.arange(len(mesh.nodes)), body.fixed)
        terms = tuple(
            StrainTerm(
                csr_array(term.gradients[:, free]),
                term.volumes,
                term.first_lame,
                term.shear_modulus,
            )
            for term in whole.terms
        )
        surface = np.searchsorted(free, body.compliance.free_surface)
        motions = RigidMotions.of(body.inertia, mesh.nodes) if body.is_free else None
        return cls(Solid(terms, len(free), own_law), free, surface, mesh.nodes[free], motions)

    @property
    def node_count(self) -> int:
        """Number of free nodes, f."""
        return len(self.free)

    def energy(self, displacements: NDArray[np.float64]) -> float:
        """Strain energy at displacements (f, 3), joule."""
        return self.solid.energy(displacements)

    def forces(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces (f, 3) that hold the free nodes at displacements (f, 3), newton."""
        return self.solid.forces(displacements)

    def linear(self, nodal_forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacements (f, 3) that linear elasticity gives for forces (f, 3), K^-1 F."""
        return linear_under(self.factor, self.motions, nodal_forces)

    @cached_property
    def elimination(self) -> RepeatedElimination:
        """Symbolic factorization of the tangents, which have one pattern."""
        pattern = self.solid.pattern
        return RepeatedElimination.of(pattern.rows, pattern.columns, self.positions)

    @cached_property
    def factor(self) -> CholeskyFactor:
        """The factor of K, for :meth:`~CholeskyFactor.solve` with (3f,) or (3f, k); without pins
        that of K with a hold whose forces vanish where loads balance.

        Solves only read it, so that several threads may share it.

        Raises
        ------
        PalpateError
            The pins do not hold the body.
        """
        try:
            return self.elimination.factor(self._held_blocks)
        except NotPositiveDefiniteError:
            raise PalpateError(
                "stiffness: the body is not held by its pins, as far as its numbers tell; pin "
                "every part at three nodes that are not on a line, and bake again"
            ) from None

    @property
    def _held_blocks(self) -> NDArray[np.float64]:
        pattern = self.solid.pattern
        blocks = self.solid.tangent_blocks(np.zeros((self.node_count, 3)))
        if self.motions is None:
            return blocks
        held = hold(self.positions, pattern.usual_firmness(blocks))
        for node, springs in zip(*held, strict=True):
            blocks[pattern.own[node]] += springs
        return blocks

    def on_free_nodes(
        self, nodes: NDArray[np.int64], nodal_forces: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Forces (f, 3) from ``nodal_forces`` (k, 3) on ``nodes`` (k,) of the mesh.

        Forces on a node that occurs more than once are added; those on pinned nodes are left out.
        """
        places = np.searchsorted(self.free, nodes)
        held = places < self.node_count
        held[held] = self.free[places[held]] == np.asarray(nodes)[held]
        forces = np.zeros((self.node_count, 3))
        np.add.at(forces, places[held], np.asarray(nodal_forces)[held])
        return forces


def linear_under(
    factor: CholeskyFactor, motions: RigidMotions | None, forces: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Linear displacements (f, 3) under forces (f, 3); ``motions`` are a free body's."""
    if motions is None:
        return factor.solve(forces.ravel()).reshape(-1, 3)
    return motions.still(factor.solve(motions.balanced(forces).ravel()).reshape(-1, 3))
