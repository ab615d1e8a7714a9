"""Soft body: rest shape, pins, compliance; deformed shapes from forces."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..compliance.free_body.inertia import Inertia
from ..compliance.protocol import Compliance
from ..errors import PalpateError
from ..law.of_material import RUBBER
from ..mesh.closest_point import ClosestPoints
from ..mesh.fit import Fit
from ..mesh.tet_mesh import TetMesh
from .body_key import body_key


@dataclass(frozen=True, eq=False)
class SoftBody:
    """Body with all that a touch needs.

    Attributes
    ----------
    mesh : the tetrahedra at rest.
    fixed : int64, numbers of the pinned nodes, ascending; none of a free body.
    poisson_ratio : of the compliance.
    compliance : of the free surface nodes, at unit modulus; of a free body that of loads which its
        inertia balances, without rigid motion, see :mod:`..compliance.free_body`.
    young_modulus : pascal; the default of a touch. Not baked in.
    formulation : of the stiffness; see :mod:`..stiffness.formulation`.
    young_scale : float64 (M,), factor of Young's modulus per tetrahedron; None where all are 1.
    fit : to the surface that the mesh was made from; None where that is not known.
    density : kg/m3, of a free body always; else None where it is not known.
    law : a name of :data:`..law.of_material.LAWS`, by which it gives way at depth. Not baked in.
    older_key : of a body file from before -0.0 was 0.0 for the key; else None.
    in_hand : whether a hand holds a free body: it does not move as a whole, and what does not
        balance is carried by its mass.
    """

    mesh: TetMesh
    fixed: NDArray[np.int64]
    poisson_ratio: float
    compliance: Compliance
    young_modulus: float
    formulation: str = "linear"
    young_scale: NDArray[np.float64] | None = None
    fit: Fit | None = None
    older_key: str | None = None
    density: float | None = None
    law: str = RUBBER
    in_hand: bool = False

    @cached_property
    def key(self) -> str:
        """Digest of all that the compliance depends on; see :func:`.body_key.body_key`."""
        return self.older_key or body_key(
            self.mesh, self.fixed, self.poisson_ratio, self.formulation, self.young_scale
        )

    @property
    def is_free(self) -> bool:
        """Whether nothing is pinned: the body as a whole may move."""
        return not len(self.fixed)

    @cached_property
    def inertia(self) -> Inertia:
        """Mass, centre and moments over the density."""
        return Inertia.of(self.mesh)

    @property
    def mass(self) -> float:
        """Kilograms.

        Raises
        ------
        PalpateError
            The density is not known.
        """
        if self.density is None:
            raise PalpateError(
                "the body has no density, so its mass is not known; bake it again with one"
            )
        return self.density * self.inertia.volume

    @property
    def moments(self) -> NDArray[np.float64]:
        """Moments of inertia about the centre of mass, kg m2, (3, 3); errors as of ``mass``."""
        return self.mass / self.inertia.volume * self.inertia.moments

    @cached_property
    def contact_blocks(self) -> NDArray[np.float64]:
        """L_aa^-1 at unit modulus for every node of ``mesh.surface_nodes``, (s, 3, 3).

        A pinned node has no L_aa; the paper leaves it open. Here it answers as firmly as the
        firmest free node of the body, alike in all directions, so that a pinned place feels firm
        and the force stays finite and continuous.
        """
        blocks = np.tile(
            1.0 / self.pinned_compliance * np.eye(3), (len(self.mesh.surface_nodes), 1, 1)
        )
        free = np.searchsorted(self.mesh.surface_nodes, self.compliance.free_surface)
        inverse = np.linalg.inv(self.compliance.diagonal())
        blocks[free] = 0.5 * (inverse + inverse.transpose(0, 2, 1))
        return blocks

    @cached_property
    def pinned_compliance(self) -> float:
        """Compliance of a pinned place at unit modulus, alike in all directions.

        That of the firmest free node in its firmest direction; see :attr:`contact_blocks`.
        """
        return float(np.linalg.eigvalsh(self.compliance.diagonal())[:, 0].min())

    def surface_blocks(self, a: ArrayLike, b: ArrayLike) -> NDArray[np.float64]:
        """L_pq at unit modulus for every p of ``a`` and q of ``b``, (len a, len b, 3, 3).

        Nodes are counted as in ``mesh.surface_nodes``; any of them may occur more than once. A
        pinned node answers to forces on itself by :attr:`pinned_compliance`, to no other, and
        moves no other, so that L stays symmetric and positive definite with pins among the nodes.
        """
        seen, loaded = (np.asarray(nodes, dtype=np.int64).reshape(-1) for nodes in (a, b))
        rows = self.free_index(self.mesh.surface_nodes[seen])
        columns = self.free_index(self.mesh.surface_nodes[loaded])
        is_row_free, is_column_free = rows >= 0, columns >= 0
        if is_row_free.all() and is_column_free.all():
            return self.compliance.blocks(rows, columns)
        blocks = np.zeros((len(seen), len(loaded), 3, 3))
        blocks[np.ix_(is_row_free, is_column_free)] = self.compliance.blocks(
            rows[is_row_free], columns[is_column_free]
        )
        blocks[(seen[:, None] == loaded) & ~is_row_free[:, None]] = self.pinned_compliance * np.eye(
            3
        )
        return blocks

    @cached_property
    def closest_points(self) -> ClosestPoints:
        """The search for places on the rest surface; triangles count as in the mesh's surface."""
        return ClosestPoints(self.mesh.nodes, self.mesh.surface_triangles)

    def modulus(self, young_modulus: float | None) -> float:
        """Young's modulus in pascal: the one that is given, or the body's own.

        Raises
        ------
        PalpateError
            It is not a positive number.
        """
        modulus = self.young_modulus if young_modulus is None else young_modulus
        if not (math.isfinite(modulus) and modulus > 0.0):
            raise PalpateError(
                "Young's modulus is {modulus} Pa; give a positive number", modulus=modulus
            )
        return modulus

    def deform(
        self,
        nodes: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None = None,
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) of the free surface nodes under forces on some nodes (15).

        ``nodes`` (k,) are node numbers of the mesh, ``nodal_forces`` (k, 3) newton. Forces on a
        node that occurs more than once are summed; forces on pinned nodes move nothing.
        """
        modulus = self.modulus(young_modulus)
        free, forces = self._on_free_nodes(
            np.asarray(nodes).reshape(-1), np.asarray(nodal_forces).reshape(-1, 3)
        )
        return self.compliance.apply(forces / modulus, free)

    def _on_free_nodes(
        self, nodes: NDArray[np.int64], forces: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        free = self.free_index(nodes)
        # Of three numbers a list is looked through several times faster than an array.
        numbers = free.tolist()
        if min(numbers, default=0) < 0:
            free, forces = free[free >= 0], forces[free >= 0]
        if len(set(numbers)) == len(numbers):
            return free, forces
        once, which = np.unique(free, return_inverse=True)
        sums = np.zeros((len(once), 3))
        np.add.at(sums, which, forces)
        return once, sums

    def free_index(self, nodes: NDArray[np.int64]) -> NDArray[np.int64]:
        """Positions of nodes in ``free_surface``, -1 for pinned ones."""
        return self._free_places[nodes]

    @cached_property
    def _free_places(self) -> NDArray[np.int64]:
        """The position in ``free_surface`` of every node of the mesh, -1 for others, (N,)."""
        places = np.full(len(self.mesh.nodes), -1, dtype=np.int64)
        places[self.compliance.free_surface] = np.arange(self.compliance.node_count)
        return places
