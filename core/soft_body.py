"""A body ready to be touched: rest shape, pins, compliance; from a finger to a deformed shape."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .body_key import body_key
from .closest_point import ClosestPoints
from .compliance import Compliance
from .contact import Touch, triangle_forces
from .coordinates import LARGEST_COORDINATE
from .errors import PalpateError
from .tet_mesh import TetMesh


@dataclass(frozen=True, eq=False)
class SoftBody:
    """Everything a touch needs.

    Attributes
    ----------
    mesh : the tetrahedra at rest.
    fixed : int64, numbers of the pinned nodes, ascending.
    poisson_ratio : the one the compliance was computed with.
    compliance : of the free surface nodes, at unit modulus.
    young_modulus : pascal; what a touch uses unless told otherwise. Not baked in.
    formulation : of the stiffness the compliance comes from; see :mod:`.formulation`.
    young_scale : float64 (M,), factor of Young's modulus per tetrahedron; None where all are 1.
    """

    mesh: TetMesh
    fixed: NDArray[np.int64]
    poisson_ratio: float
    compliance: Compliance
    young_modulus: float
    formulation: str = "linear"
    young_scale: NDArray[np.float64] | None = None

    @cached_property
    def key(self) -> str:
        """Digest of all that the compliance depends on; see :func:`.body_key.body_key`."""
        return body_key(
            self.mesh, self.fixed, self.poisson_ratio, self.formulation, self.young_scale
        )

    @cached_property
    def contact_blocks(self) -> NDArray[np.float64]:
        """L_aa^-1 at unit modulus for every node of ``mesh.surface_nodes``, (s, 3, 3).

        A pinned node has no L_aa; the paper leaves it open. Here it answers as firmly as the
        firmest free node of the body, alike in all directions, so that a pinned place feels firm
        and the force stays finite and continuous.
        """
        diagonal = self.compliance.diagonal()
        firmest = 1.0 / float(np.linalg.eigvalsh(diagonal)[:, 0].min())
        blocks = np.tile(firmest * np.eye(3), (len(self.mesh.surface_nodes), 1, 1))
        free = np.searchsorted(self.mesh.surface_nodes, self.compliance.free_surface)
        inverse = np.linalg.inv(diagonal)
        blocks[free] = 0.5 * (inverse + inverse.transpose(0, 2, 1))
        return blocks

    @cached_property
    def closest_points(self) -> ClosestPoints:
        """The search for places on the rest surface; triangles count as in the mesh's surface."""
        return ClosestPoints(self.mesh.nodes, self.mesh.surface_triangles)

    def touch_nearest(
        self, at: ArrayLike, by: ArrayLike, young_modulus: float | None = None
    ) -> Touch:
        """Touch at the surface point nearest to ``at`` (3,), displaced by ``by`` (3,), metres.

        Raises
        ------
        PalpateError
            Coordinates that are not three finite numbers.
        """
        place = self.closest_points.query(_point_checked("at", at))
        return self.touch(
            int(place.triangle[0]), place.alpha[0], _point_checked("by", by), young_modulus
        )

    def touch(
        self,
        triangle: int,
        alpha: ArrayLike,
        displacement: ArrayLike,
        young_modulus: float | None = None,
    ) -> Touch:
        """Touch surface triangle number ``triangle`` at area coordinates ``alpha`` (11)-(14)."""
        corners = self.mesh.surface_triangles[triangle]
        weights = np.asarray(alpha, dtype=np.float64)
        u = np.asarray(displacement, dtype=np.float64)
        modulus = self.young_modulus if young_modulus is None else young_modulus
        blocks = modulus * self.contact_blocks[self.mesh.surface_local_triangles[triangle]]
        return Touch(
            triangle=corners,
            alpha=weights,
            point=weights @ self.mesh.nodes[corners],
            displacement=u,
            nodal_forces=triangle_forces(blocks, weights, u),
        )

    def deform(
        self,
        triangle: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None = None,
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) of the free surface nodes under forces on three nodes (15).

        ``triangle`` (3,) are node numbers; forces on pinned nodes move nothing.
        """
        modulus = self.young_modulus if young_modulus is None else young_modulus
        free, forces = self._on_free_nodes(triangle, nodal_forces)
        return self.compliance.apply(forces / modulus, free)

    def contact_displacement(
        self, touch: Touch, displacements: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """How far the touched point itself moves, (3,), given the displacements (n, 3)."""
        free, corner = self.free_index(touch.triangle), np.arange(3)
        held = free >= 0
        moved: NDArray[np.float64] = touch.alpha[corner[held]] @ displacements[free[held]]
        return moved

    def _on_free_nodes(
        self, nodes: NDArray[np.int64], forces: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        free = self.free_index(nodes)
        # Of three numbers a list is looked through several times faster than an array.
        if min(free.tolist()) >= 0:
            return free, forces
        return free[free >= 0], forces[free >= 0]

    def free_index(self, nodes: NDArray[np.int64]) -> NDArray[np.int64]:
        """Positions of nodes in ``free_surface``, -1 for pinned ones."""
        return self._free_places[nodes]

    @cached_property
    def _free_places(self) -> NDArray[np.int64]:
        """The position in ``free_surface`` of every node of the mesh, -1 for others, (N,)."""
        places = np.full(len(self.mesh.nodes), -1, dtype=np.int64)
        places[self.compliance.free_surface] = np.arange(self.compliance.node_count)
        return places


def _point_checked(name: str, value: ArrayLike) -> NDArray[np.float64]:
    point = np.asarray(value, dtype=np.float64)
    if point.shape != (3,) or not (np.abs(point) <= LARGEST_COORDINATE).all():
        raise PalpateError(
            f"--{name}: {np.asarray(value).tolist()} is not a point; give three finite numbers "
            f"in metres, none beyond {LARGEST_COORDINATE:g}"
        )
    return point
