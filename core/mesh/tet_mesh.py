"""Checked tetrahedral mesh: its boundary, surface nodes and volume."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..errors import PalpateError
from ..sentence import Sentence
from .coordinates import refuse_rounded, refuse_unusable

# The four faces of a positively oriented tetrahedron, wound so that normals point outward.
OUTWARD_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])

# A tetrahedron thinner than this share of its longest edge cubed has no usable stiffness.
SMALLEST_RELATIVE_VOLUME = 1e-12

# Largest factor, up or down, on the body's Young's modulus: enough for steel in foam, and far from
# where rounding would hide the softer part.
LARGEST_SCALE = 1e6


@dataclass(frozen=True, eq=False)
class TetMesh:
    """Four-node tetrahedra. Build with :meth:`checked`, which refuses what FEM cannot use.

    Attributes
    ----------
    nodes : float64 (N, 3), metres.
    tets : int64 (M, 4), node numbers, positively oriented.
    """

    nodes: NDArray[np.float64]
    tets: NDArray[np.int64]

    @classmethod
    def checked(cls, nodes: ArrayLike, tets: ArrayLike) -> TetMesh:
        """Make a mesh from arrays of shape (N, 3) and (M, 4), both copied.

        >>> mesh = TetMesh.checked([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]])
        >>> mesh.surface_triangles.shape, round(6 * mesh.volume, 9)
        ((4, 3), 1.0)

        Raises
        ------
        PalpateError
            Wrong shapes, numbers that are not finite, node numbers out of range, inverted or
            zero-volume tetrahedra, nodes that no tetrahedron uses.
        """
        node_array = _nodes_checked(nodes)
        tet_array = _tets_checked(tets, len(node_array))
        _refuse_flat_or_inverted(node_array, tet_array)
        unused = np.setdiff1d(np.arange(len(node_array)), tet_array)
        if unused.size:
            raise PalpateError(
                "tetrahedral mesh: {count} of {all} nodes belong to no tetrahedron (first: node "
                "{first}); remove unused nodes and renumber",
                count=unused.size,
                all=len(node_array),
                first=unused[0],
            )
        node_array.setflags(write=False)
        tet_array.setflags(write=False)
        return cls(node_array, tet_array)

    @cached_property
    def tet_volumes(self) -> NDArray[np.float64]:
        """Volume of each tetrahedron, (M,), cubic metres."""
        return signed_volumes(self.nodes, self.tets)

    @property
    def volume(self) -> float:
        """Volume of the body in cubic metres."""
        return float(self.tet_volumes.sum())

    @cached_property
    def surface_triangles(self) -> NDArray[np.int64]:
        """Boundary faces, (S, 3) node numbers, wound so that normals point outward."""
        faces = self.tets[:, OUTWARD_FACES].reshape(-1, 3)
        corners = np.sort(faces, axis=1)
        order = np.lexsort(corners.T)
        differs = (corners[order][1:] != corners[order][:-1]).any(axis=1)
        starts = np.flatnonzero(np.concatenate([[True], differs]))
        count = np.diff(starts, append=len(faces))
        if count.max() > 2:
            crowded = corners[order[starts[np.argmax(count)]]]
            raise PalpateError(
                "tetrahedral mesh: the face {face} belongs to {count} tetrahedra, so they "
                "overlap; bake the surface again",
                face=tuple(crowded.tolist()),
                count=count.max(),
            )
        boundary: NDArray[np.int64] = faces[np.sort(order[starts[count == 1]])]
        return boundary

    @cached_property
    def surface_nodes(self) -> NDArray[np.int64]:
        """Numbers of the nodes on the boundary, ascending."""
        return np.unique(self.surface_triangles)

    @cached_property
    def surface_local_triangles(self) -> NDArray[np.int64]:
        """Boundary faces, (S, 3), counted within :attr:`surface_nodes`."""
        return np.searchsorted(self.surface_nodes, self.surface_triangles)

    @cached_property
    def node_components(self) -> NDArray[np.int64]:
        """Number of the connected piece of each node, (N,)."""
        return pieces(self.tets, len(self.nodes))

    @property
    def component_count(self) -> int:
        """Number of connected pieces; pieces that share no node move freely."""
        return int(self.node_components.max()) + 1


def signed_volumes(nodes: NDArray[np.float64], tets: NDArray[np.int64]) -> NDArray[np.float64]:
    """Volumes of tetrahedra, (M,); negative where the winding is inverted."""
    origin = nodes[tets[:, 0]]
    a, b, c = (nodes[tets[:, corner]] - origin for corner in (1, 2, 3))
    volumes: NDArray[np.float64] = np.einsum("ij,ij->i", np.cross(a, b), c) / 6.0
    return volumes


def pieces(corners: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Number of the connected piece of each of ``count`` nodes, (count,), from the node numbers of
    pairs, triangles or tetrahedra, (k, 2 to 4); nodes of none are pieces of their own.
    """
    others = corners[:, 1:]
    first = np.repeat(corners[:, 0], others.shape[1])
    links = coo_array(
        (np.ones(first.size, dtype=np.int8), (first, others.ravel())), shape=(count, count)
    )
    return connected_components(links, directed=False)[1].astype(np.int64)


def _nodes_checked(nodes: ArrayLike) -> NDArray[np.float64]:
    given = np.asarray(nodes)
    if given.ndim != 2 or given.shape[1] != 3 or not len(given):
        raise PalpateError(
            "tetrahedral mesh: nodes have shape {shape}, expected (N, 3) with N > 0; give one row "
            "of x, y, z in metres per node",
            shape=given.shape,
        )
    if given.dtype.kind not in "fiu":
        raise PalpateError(
            "tetrahedral mesh: nodes are {kind}, expected real numbers; give metres",
            kind=given.dtype,
        )
    array = given.astype(np.float64, order="C")
    refuse_unusable(Sentence("tetrahedral mesh"), array)
    refuse_rounded(Sentence("tetrahedral mesh"), given)
    return array


def _tets_checked(tets: ArrayLike, node_count: int) -> NDArray[np.int64]:
    given = np.asarray(tets)
    if given.ndim != 2 or given.shape[1] != 4 or not len(given):
        raise PalpateError(
            "tetrahedral mesh: tets have shape {shape}, expected (M, 4) with M > 0; give one row "
            "of four node numbers per tetrahedron",
            shape=given.shape,
        )
    if not np.issubdtype(given.dtype, np.integer):
        raise PalpateError(
            "tetrahedral mesh: tets are {kind}, expected integers; give node numbers",
            kind=given.dtype,
        )
    # Before they become signed.
    if given.min() < 0 or given.max() >= node_count:
        wrong = int(given.min()) if given.min() < 0 else int(given.max())
        raise PalpateError(
            "tetrahedral mesh: a tetrahedron names node {wrong}, but nodes are numbered 0 to "
            "{last}; count from zero",
            wrong=wrong,
            last=node_count - 1,
        )
    return given.astype(np.int64)


def _refuse_flat_or_inverted(nodes: NDArray[np.float64], tets: NDArray[np.int64]) -> None:
    volumes = signed_volumes(nodes, tets)
    corners = nodes[tets]
    pairs = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
    longest = np.max(
        [np.linalg.norm(corners[:, i] - corners[:, j], axis=1) for i, j in pairs], axis=0
    )
    flat = np.abs(volumes) <= SMALLEST_RELATIVE_VOLUME * longest**3
    if flat.any():
        raise PalpateError(
            "tetrahedral mesh: {count} tetrahedra have no volume (first: tetrahedron {first}); "
            "remove them or bake the surface again",
            count=int(flat.sum()),
            first=int(np.flatnonzero(flat)[0]),
        )
    inverted = volumes < 0
    if inverted.any():
        raise PalpateError(
            "tetrahedral mesh: {count} tetrahedra are inverted (first: tetrahedron {first}); swap "
            "two of their nodes",
            count=int(inverted.sum()),
            first=int(np.flatnonzero(inverted)[0]),
        )


def young_scale_checked(young_scale: ArrayLike, tet_count: int) -> NDArray[np.float64]:
    """Factors on Young's modulus as float64 (M,), if they can be used.

    Raises
    ------
    PalpateError
        Not one number a tetrahedron, or one not between 1e-6 and 1e6.
    """
    given = np.asarray(young_scale)
    if given.shape != (tet_count,) or given.dtype.kind not in "fiu":
        raise PalpateError(
            "young_scale: an array of {kind} and shape {shape} does not fit the body's "
            "tetrahedra; give one real number for each, shape ({tet_count},)",
            kind=given.dtype,
            shape=given.shape,
            tet_count=tet_count,
        )
    scale = given.astype(np.float64)
    usable = (scale >= 1 / LARGEST_SCALE) & (scale <= LARGEST_SCALE)
    if not usable.all():
        first = int(np.flatnonzero(~usable)[0])
        raise PalpateError(
            "young_scale: {count} tetrahedra have a factor on Young's modulus that is not between "
            "{least:g} and {most:g} (first: tetrahedron {first} with {factor}); 1 leaves a place "
            "as it is",
            count=int((~usable).sum()),
            least=1 / LARGEST_SCALE,
            most=LARGEST_SCALE,
            first=first,
            factor=scale[first],
        )
    return scale
