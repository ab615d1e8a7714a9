"""A coarse lattice of cubes around a body, in parts where the body is in parts.

What varies smoothly over a body is computed on far fewer nodes than it has. A cube of the lattice
is one part for each piece of the body in it, and two parts share a node of the lattice only where
the pieces hang together: two ears in one cube move apart, and so do lips.

References
----------
M. Nesme, P. G. Kry, L. Jerabkova, F. Faure: Preserving Topology and Elasticity for Embedded
Deformable Models, ACM Transactions on Graphics 28, 2009.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components

from ...mesh.tet_mesh import TetMesh
from .tet_samples import TetSamples

# Corners of a cube from 0 to 1, the last axis fastest.
CORNERS = np.array([[a, b, c] for a in (0, 1) for b in (0, 1) for c in (0, 1)])
# Nodes for each cube of a body's volume, for a first guess: surfaces are covered by whole cubes.
NODES_A_CUBE = 1.3
# Pieces of tetrahedra are no longer than this share of a cube's edge.
PIECE = 0.75


@dataclass(frozen=True, eq=False)
class Lattice:
    """Parts of cubes with trilinear interpolation.

    Attributes
    ----------
    edge : of the cubes, metres.
    positions : (c, 3), of the lattice's nodes, metres; several may stand in one place.
    origins : (p, 3), the lowest corner of every part's cube.
    corners : int64 (p, 8), every part's nodes, in the order of :data:`CORNERS`.
    samples : of the body's tetrahedra, in pieces smaller than a cube.
    sample_parts : int64 (q,), the part that each of these belongs to.
    node_parts : int64 (N,), the part by which every node of the body is interpolated.
    """

    edge: float
    positions: NDArray[np.float64]
    origins: NDArray[np.float64]
    corners: NDArray[np.int64]
    samples: TetSamples
    sample_parts: NDArray[np.int64]
    node_parts: NDArray[np.int64]

    @property
    def node_count(self) -> int:
        """Number of the lattice's nodes, c."""
        return len(self.positions)

    @classmethod
    def around(cls, mesh: TetMesh, edge: float) -> Lattice:
        """Cubes of this edge around a body, in its middle."""
        samples = TetSamples.of(mesh, PIECE * edge)
        cubes, origin, counts = _cubes(mesh, samples.points, edge)
        numbers = np.ravel_multi_index(tuple(cubes.T), tuple(counts))
        bonds = _bonds(mesh, samples)
        sample_parts = _pieces(bonds, numbers)
        part_cubes = np.empty((sample_parts.max() + 1, 3), dtype=np.int64)
        part_cubes[sample_parts] = cubes
        at = part_cubes[:, None, :] + CORNERS
        places = np.ravel_multi_index(tuple(at.T), tuple(counts + 1)).T
        corners = _shared(bonds, sample_parts, places)
        positions = np.empty((corners.max() + 1, 3))
        positions[corners.ravel()] = (origin + edge * at).reshape(-1, 3)
        origins = origin + edge * part_cubes
        node_parts = _node_parts(mesh.nodes, bonds, sample_parts, origins + 0.5 * edge)
        return cls(edge, positions, origins, corners, samples, sample_parts, node_parts)

    def local(self, points: ArrayLike, parts: NDArray[np.int64]) -> NDArray[np.float64]:
        """Coordinates (k, 3) of points in the cubes of parts (k,), 0 to 1 inside."""
        found: NDArray[np.float64] = (np.asarray(points) - self.origins[parts]) / self.edge
        return found

    def interpolation(self, points: ArrayLike, parts: NDArray[np.int64]) -> csr_array:
        """Values of the lattice's nodes taken to points (k, 3) in parts (k,), csr (k, c)."""
        along = _linear(self.local(points, parts))
        weights = along[:, :, 0] * along[:, :, 1] * along[:, :, 2]
        return self._rows(weights[:, None, :], parts)

    def gradients(self, points: ArrayLike, parts: NDArray[np.int64]) -> csr_array:
        """Derivatives there, csr (3k, c), 1/metre; row ``3 i + J`` is along J at point i."""
        along = _linear(self.local(points, parts))
        slope = (2.0 * CORNERS - 1.0) / self.edge
        weights = np.stack(
            [slope[:, axis] * along[:, :, axis - 2] * along[:, :, axis - 1] for axis in range(3)],
            axis=1,
        )
        return self._rows(weights, parts)

    def _rows(self, weights: NDArray[np.float64], parts: NDArray[np.int64]) -> csr_array:
        """Rows for weights (k, r, 8) of the corners of parts (k,)."""
        count, each, _ = weights.shape
        rows = np.arange(count * each).repeat(8)
        columns = self.corners[parts].repeat(each, axis=0).ravel()
        shape = (count * each, self.node_count)
        return coo_array((weights.ravel(), (rows, columns)), shape=shape).tocsr()


def lattice_of(mesh: TetMesh, most_nodes: int) -> Lattice:
    """The finest lattice found around a body that has at most so many nodes."""
    edge = float(np.cbrt(mesh.volume * NODES_A_CUBE / most_nodes))
    while True:
        together = _occupied_corners(mesh, edge)
        if together <= most_nodes:
            found = Lattice.around(mesh, edge)
            together = found.node_count
            if together <= most_nodes:
                return found
        edge *= max(1.02, float(np.cbrt(together / most_nodes)))


def _occupied_corners(mesh: TetMesh, edge: float) -> int:
    """Lower bound, quickly counted, of the nodes of a lattice of this edge."""
    middles = mesh.nodes[mesh.tets].mean(axis=1)
    cubes, _, counts = _cubes(mesh, middles, edge)
    once = np.unique(np.ravel_multi_index(tuple(cubes.T), tuple(counts)))
    at = np.stack(np.unravel_index(once, tuple(counts)), axis=1)[:, None, :] + CORNERS
    return len(np.unique(np.ravel_multi_index(tuple(at.T), tuple(counts + 1))))


def _cubes(
    mesh: TetMesh, points: NDArray[np.float64], edge: float
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.int64]]:
    """The cubes (q, 3) that points are in, the lattice's origin (3,), its cubes along axes (3,)."""
    low, high = mesh.nodes.min(axis=0), mesh.nodes.max(axis=0)
    counts = np.maximum(np.ceil((high - low) / edge), 1.0).astype(np.int64)
    origin = 0.5 * (low + high - edge * counts)
    cubes = np.clip(((points - origin) / edge).astype(np.int64), 0, counts - 1)
    return cubes, origin, counts


def _bonds(mesh: TetMesh, samples: TetSamples) -> NDArray[np.int64]:
    """Bonds of each sample, (q, 5): its tetrahedron's nodes, and itself."""
    whole = samples.tets[:, None] + len(mesh.nodes)
    return np.hstack([mesh.tets[samples.tets], whole])


def _pieces(bonds: NDArray[np.int64], cubes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Number of the piece of every sample: those in one cube that hang together there."""
    meetings = cubes[:, None] * (bonds.max() + 1) + bonds
    return _components(np.arange(len(bonds)).repeat(5), meetings.ravel(), len(bonds))


def _shared(
    bonds: NDArray[np.int64], sample_parts: NDArray[np.int64], places: NDArray[np.int64]
) -> NDArray[np.int64]:
    """The corners of parts, numbered; those in one place are one where parts hang together.

    ``places`` (p, 8) tells where in the lattice a corner stands.
    """
    parts, by = _parts_and_bonds(bonds, sample_parts)
    corners = 8 * parts[:, None] + np.arange(8)
    meetings = by[:, None] * (places.max() + 1) + places[parts]
    return _components(corners.ravel(), meetings.ravel(), places.size).reshape(-1, 8)


def _components(
    things: NDArray[np.int64], meetings: NDArray[np.int64], count: int
) -> NDArray[np.int64]:
    """Numbers (count,) of things, alike where they are in one meeting or in a chain of them."""
    once, which = np.unique(meetings, return_inverse=True)
    size = count + len(once)
    graph = coo_array((np.ones(len(things)), (things, count + which)), shape=(size, size))
    _, labels = connected_components(graph, directed=False)
    _, numbers = np.unique(labels[:count], return_inverse=True)
    return numbers.astype(np.int64)


def _parts_and_bonds(
    bonds: NDArray[np.int64], sample_parts: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Every part with every bond of its samples, once."""
    count = bonds.max() + 1
    parts, by = np.divmod(np.unique(sample_parts[:, None] * count + bonds), count)
    return parts, by


def _node_parts(
    positions: NDArray[np.float64],
    bonds: NDArray[np.int64],
    sample_parts: NDArray[np.int64],
    middles: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Part of each node, (N,): of those of its tetrahedra, the one with the nearest middle."""
    parts, nodes = _parts_and_bonds(bonds[:, :4], sample_parts)
    off = np.abs(positions[nodes] - middles[parts]).max(axis=1)
    order = np.lexsort((parts, off, nodes))
    _, first = np.unique(nodes[order], return_index=True)
    chosen = np.zeros(len(positions), dtype=np.int64)
    chosen[nodes[order][first]] = parts[order][first]
    return chosen


def _linear(local: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights along each axis, (k, 8, 3), of the corners of a cube at local coordinates (k, 3)."""
    at = local[:, None, :]
    return np.where(CORNERS, at, 1.0 - at)
