"""Clusters of nodes, and the pairs too near for a smooth interaction."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...stiffness.freedoms import freedoms

# Nodes in a cluster at most: larger clusters mean more near blocks, smaller ones more bases; 32 is
# the flat minimum of memory on bodies of 1,000 to 6,000 surface nodes.
LARGEST_CLUSTER = 32

# Clusters are near if their centres are closer than this times the sum of their radii.
REACH = 1.0


@dataclass(frozen=True, eq=False)
class Clusters:
    """Partition of n nodes.

    Attributes
    ----------
    members : for each cluster the nodes in it, (at most 32,) each.
    near : bool (q, q), whether two clusters are neighbours; symmetric, true on the diagonal.
    """

    members: tuple[NDArray[np.int64], ...]
    near: NDArray[np.bool_]

    @property
    def count(self) -> int:
        """Number of clusters, q."""
        return len(self.members)

    @cached_property
    def freedoms(self) -> NDArray[np.int64]:
        """Degrees of freedom, cluster after cluster, (3n,)."""
        return freedoms(np.concatenate(self.members))

    @cached_property
    def starts(self) -> NDArray[np.int64]:
        """Start of each cluster in ``freedoms``, and its length, (q + 1,)."""
        sizes = [3 * len(nodes) for nodes in self.members]
        return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)

    def span(self, cluster: int) -> slice:
        """Slice of ``freedoms`` that belongs to a cluster."""
        return slice(int(self.starts[cluster]), int(self.starts[cluster + 1]))

    def all_near(self) -> Clusters:
        """The same partition with all clusters neighbours."""
        return Clusters(self.members, np.ones_like(self.near))

    def spread(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """One value a cluster (q,) repeated for each of its degrees of freedom, (3n,)."""
        return np.repeat(values, np.diff(self.starts))


def cluster_nodes(positions: NDArray[np.float64], largest: int = LARGEST_CLUSTER) -> Clusters:
    """Halve the nodes at the middle of their longest extent until clusters are small (kd-tree).

    ``positions`` (n, 3), metres. All clusters are equally large, to one node or two.
    """
    members: list[NDArray[np.int64]] = []
    waiting = [np.arange(len(positions))]
    while waiting:
        nodes = waiting.pop()
        if len(nodes) <= largest:
            members.append(nodes)
            continue
        axis = int(np.argmax(np.ptp(positions[nodes], axis=0)))
        along = nodes[np.argsort(positions[nodes, axis], kind="stable")]
        parts = -(-len(nodes) // largest)
        middle = (parts // 2) * len(nodes) // parts
        waiting += [along[middle:], along[:middle]]
    middles = np.array([positions[nodes].mean(axis=0) for nodes in members])
    radii = np.array(
        [
            np.linalg.norm(positions[nodes] - middle, axis=1).max()
            for nodes, middle in zip(members, middles, strict=True)
        ]
    )
    distances = np.linalg.norm(middles[:, None] - middles[None], axis=2)
    near = distances <= REACH * (radii[:, None] + radii[None])
    np.fill_diagonal(near, val=True)
    return Clusters(tuple(members), near)
