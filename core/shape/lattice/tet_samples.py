"""Tetrahedra as points with volumes, closer together than a given length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...mesh.tet_mesh import TetMesh

# A tetrahedron is cut so often in halves along its edges, at most.
MOST_CUTS = 4
# The two ends of each edge, and the eight tetrahedra between corners (0 to 3) and the middles of
# these edges (4 to 9).
EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
EIGHT = np.array(
    [
        [0, 4, 5, 6],
        [1, 4, 7, 8],
        [2, 5, 7, 9],
        [3, 6, 8, 9],
        [4, 5, 6, 8],
        [4, 5, 7, 8],
        [5, 6, 8, 9],
        [5, 7, 8, 9],
    ]
)


@dataclass(frozen=True, eq=False)
class TetSamples:
    """Points that stand for equal pieces of tetrahedra.

    Attributes
    ----------
    tets : int64 (q,), whose piece each is.
    points : (q, 3), the middles of the pieces, metres.
    volumes : (q,), cubic metres.
    moments : (q,), second moment of a piece about its middle, the three axes together, m^5.
    """

    tets: NDArray[np.int64]
    points: NDArray[np.float64]
    volumes: NDArray[np.float64]
    moments: NDArray[np.float64]

    @classmethod
    def of(cls, mesh: TetMesh, length: float) -> TetSamples:
        """Samples of a body; longer edges than ``length`` are halved, up to :data:`MOST_CUTS`."""
        corners = mesh.nodes[mesh.tets]
        longest = np.linalg.norm(corners[:, EDGES[:, 0]] - corners[:, EDGES[:, 1]], axis=2)
        halvings = np.ceil(np.log2(np.maximum(longest.max(axis=1) / length, 1.0)))
        cuts = np.minimum(halvings, MOST_CUTS).astype(np.int64)
        # A tetrahedron's second moment is V / 20 times the squares of its corners about its middle.
        away = corners - corners.mean(axis=1, keepdims=True)
        spread = np.einsum("tcj,tcj->t", away, away) / 20
        parts = [_cut(corners, mesh.tet_volumes, spread, cuts, times) for times in np.unique(cuts)]
        return cls(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _cut(
    corners: NDArray[np.float64],
    volumes: NDArray[np.float64],
    spread: NDArray[np.float64],
    cuts: NDArray[np.int64],
    times: int,
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """The fields of :class:`TetSamples` of those that are cut so many times."""
    (tets,) = np.nonzero(cuts == times)
    middles = _middles(times)
    count = len(middles)
    points = np.einsum("qc,tcj->tqj", middles, corners[tets])
    own = np.repeat(volumes[tets] / count, count)
    away = points - corners[tets].mean(axis=1, keepdims=True)
    # What the pieces' places do not have of the whole's moment, they have about their middles.
    between = np.einsum("tqj,tqj->t", away, away) / count
    within = own * np.repeat(spread[tets] - between, count)
    return tets.repeat(count), points.reshape(-1, 3), own, within


def _middles(times: int) -> NDArray[np.float64]:
    """Barycentric coordinates (8^times, 4) of the middles of a tetrahedron's pieces."""
    pieces = np.eye(4)[None]
    for _ in range(times):
        between = 0.5 * (pieces[:, EDGES[:, 0]] + pieces[:, EDGES[:, 1]])
        pieces = np.concatenate([pieces, between], axis=1)[:, EIGHT].reshape(-1, 4, 4)
    middles: NDArray[np.float64] = pieces.mean(axis=1)
    return middles
