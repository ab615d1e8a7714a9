"""The surface nodes that a grip reaches, and how firmly it holds each."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..body.soft_body import SoftBody
from ..errors import PalpateError
from ..mesh.tet_mesh import TetMesh
from .motions import fields_at

Array = NDArray[np.float64]

# Share of the radius within which the patch moves exactly as asked.
CORE = 0.25
# Least radius in longest edges of the touched triangle: a patch, never a single node.
LEAST_EDGES = 1.5
# Nodes whose normal has a smaller product with the place's are beyond an edge or on the far side.
FACING = -0.2
# Share of the radius over which the hold fades in beside pins.
BESIDE_PINS = 0.5
# Below this firmness a node is let go.
LEAST_FIRMNESS = 1e-3


@dataclass(frozen=True, eq=False)
class Grip:
    """Place on the rest surface to take hold of.

    Attributes
    ----------
    triangle : number of the surface triangle.
    alpha : float64 (3,), area coordinates there.
    normal : float64 (3,), outward unit normal, the axis of turns and of drawing in.
    radius : metres.
    mirror : float64 (3, 3), what turns the motion asked for into this grip's: of mirrored copies.
    """

    triangle: int
    alpha: Array
    normal: Array
    radius: float
    mirror: Array = field(default_factory=lambda: np.eye(3))

    def centre(self, mesh: TetMesh) -> Array:
        """The place, (3,), metres."""
        centre: Array = self.alpha @ mesh.nodes[mesh.surface_triangles[self.triangle]]
        return centre

    def fields(self, mesh: TetMesh, places: Array) -> Array:
        """Its motions (k, 3, 5) at ``places`` (k, 3); see :mod:`.motions`."""
        back = np.linalg.inv(self.mirror)
        axis = back @ self.normal
        fields = fields_at(
            (places - self.centre(mesh)) @ back.T, np.zeros(3), axis / np.linalg.norm(axis)
        )
        mirrored: Array = np.einsum("xy,kym->kxm", self.mirror, fields)
        return mirrored


@dataclass(frozen=True, eq=False)
class Patch:
    """Nodes held by a grip.

    Attributes
    ----------
    nodes : int64 (k,), surface-local numbers of free nodes, ascending.
    firmness : float64 (k,), 1 where a node moves exactly as asked, to 0 at the rim.
    radius : metres: the grip's, or a larger one where the mesh is coarser.
    """

    nodes: NDArray[np.int64]
    firmness: Array
    radius: float


def patch_of(body: SoftBody, grip: Grip, normals: Array) -> Patch:
    """Nodes around a grip's place that are connected with it by the surface within its radius.

    ``normals`` (s, 3) are the outward unit normals of the surface nodes.

    Raises
    ------
    PalpateError
        All nodes there are pinned.
    """
    mesh = body.mesh
    corners = mesh.surface_local_triangles[grip.triangle]
    places = mesh.nodes[mesh.surface_nodes]
    radius = max(grip.radius, LEAST_EDGES * _longest_edge(places[corners]))
    away = np.linalg.norm(places - grip.centre(mesh), axis=1)
    within = (away < radius) & (normals @ grip.normal > FACING)
    within[corners] = True
    reached = _connected(mesh.surface_local_triangles, within, corners[0])
    firmness = _fading(np.clip((away[reached] / radius - CORE) / (1.0 - CORE), 0.0, 1.0))
    # The place itself moves as asked also where the triangle is as large as the patch.
    firmness[np.isin(reached, corners[grip.alpha > 0.0])] = 1.0
    free = body.free_index(mesh.surface_nodes[reached]) >= 0
    if not free.all():
        pins = cKDTree(places[reached[~free]])
        beside = pins.query(places[reached])[0] / (BESIDE_PINS * radius)
        firmness *= 1.0 - _fading(np.clip(beside, 0.0, 1.0))
    held = free & (firmness > LEAST_FIRMNESS)
    if not held.any():
        raise PalpateError("this place is pinned; take hold of another one, or pin less")
    return Patch(reached[held], firmness[held], radius)


def _fading(share: Array) -> Array:
    """From 1 at a share of 0 to 0 at 1, smooth at both ends."""
    faded: Array = (1.0 - share**2) ** 2
    return faded


def _longest_edge(corners: Array) -> float:
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).max())


def _connected(
    triangles: NDArray[np.int64], within: NDArray[np.bool_], start: int
) -> NDArray[np.int64]:
    """Nodes that edges between nodes ``within`` connect with ``start``, ascending."""
    chosen = np.flatnonzero(within)
    number = np.full(len(within), -1)
    number[chosen] = np.arange(len(chosen))
    ends = np.concatenate([triangles, np.roll(triangles, 1, axis=1)]).reshape(2, -1)
    ends = number[ends]
    ends = ends[:, (ends >= 0).all(axis=0)]
    graph = coo_array((np.ones(ends.shape[1]), tuple(ends)), shape=(len(chosen), len(chosen)))
    _, piece = connected_components(graph, directed=False)
    reached: NDArray[np.int64] = chosen[piece == piece[number[start]]]
    return reached
