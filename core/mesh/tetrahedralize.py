"""Tetrahedralization of a surface by fTetWild, and a check of the fit.

fTetWild cannot be interrupted and writes files into the working directory, so these functions are
meant to run in the child process of :mod:`.bake_job`, inside a temporary folder.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from .closest_point import ClosestPoints
from .surface import Surface
from .tet_mesh import OUTWARD_FACES, TetMesh, pieces, signed_volumes
from .winding_volume import enclosed_volume, is_inside, sampled_volume

# Face-connected pieces below this share of the volume are debris of the envelope, not parts.
CRUMB_SHARE = 1e-3

# Bounds of the volume ratio; outside, the tetrahedra fill something else.
VOLUME_RATIO_BOUNDS = (0.5, 1.5)

# A larger difference is checked against the winding number.
DOUBTFUL_VOLUME_ERROR = 0.1

# Input vertices farther than this share of the diagonal may be walls between merged parts.
BURIED_DISTANCE = 0.01


@dataclass(frozen=True)
class Fit:
    """Fit of tetrahedra to the surface they were made from.

    Attributes
    ----------
    volume_ratio : volume of the tetrahedra over the volume the input encloses.
    body_to_input, input_to_body : largest distance from one surface to the other, metres.
    """

    volume_ratio: float
    body_to_input: float
    input_to_body: float


def tetrahedralize(surface: Surface, edge_length: float, epsilon: float) -> TetMesh:
    """Fill a surface with tetrahedra.

    Parameters
    ----------
    surface : may be open, overlapping, or in several parts.
    edge_length : wanted length of edges, as a share of the bounding box diagonal.
    epsilon : how far the body's surface may lie from the input's, as such a share.

    Raises
    ------
    PalpateError
        The surface encloses nothing that fTetWild could fill.
    """
    from pytetwild.pytetwild import tetrahedralize as ftetwild

    nodes, tets = ftetwild(
        surface.vertices,
        surface.triangles.astype(np.int32),
        edge_length_fac=edge_length,
        epsilon=epsilon,
        quiet=False,
        loglevel=2,
    )
    if not len(tets):
        raise PalpateError(
            "tetrahedralization: the surface encloses no volume; close its holes, give sheets "
            "thickness (Solidify), or recalculate its normals to point outside"
        )
    return _cleaned(np.asarray(nodes, dtype=np.float64), np.asarray(tets, dtype=np.int64))


def check_fit(mesh: TetMesh, surface: Surface, shell: Surface) -> Fit:
    """Compare a body with the ``surface`` it was made from.

    ``shell`` is the same surface decimated, as it was handed to fTetWild; the volume is taken
    from it.

    Raises
    ------
    PalpateError
        The volumes have nothing to do with each other.
    """
    volume = enclosed_volume(shell)
    if abs(mesh.volume - volume) > DOUBTFUL_VOLUME_ERROR * volume:
        # The surface may intersect itself; this costs a second or two.
        volume = sampled_volume(shell)
    ratio = mesh.volume / volume if volume > 0 else float("inf")
    if not VOLUME_RATIO_BOUNDS[0] < ratio < VOLUME_RATIO_BOUNDS[1]:
        raise PalpateError(
            "tetrahedralization: the body has {body:.3g} cm3, but the surface encloses about "
            "{surface:.3g} cm3; close large holes, recalculate normals, or use a smaller edge "
            "length",
            body=mesh.volume * 1e6,
            surface=volume * 1e6,
        )
    body_surface = Surface(mesh.nodes, mesh.surface_triangles)
    centres = mesh.nodes[mesh.surface_triangles].mean(axis=1)
    probes = np.concatenate([mesh.nodes[mesh.surface_nodes], centres])
    to_input = ClosestPoints(surface.vertices, surface.triangles).query(probes).distance.max()
    return Fit(float(ratio), float(to_input), _farthest_outside(surface, body_surface))


def _farthest_outside(surface: Surface, body: Surface) -> float:
    """Largest distance of the input's vertices from the body; those inside do not count."""
    used = surface.vertices[np.unique(surface.triangles)]
    distance = ClosestPoints(body.vertices, body.triangles).query(used).distance
    far = np.flatnonzero(distance > BURIED_DISTANCE * surface.diagonal)
    distance[far[is_inside(used[far], body)]] = 0.0
    return float(distance.max())


def _cleaned(nodes: NDArray[np.float64], tets: NDArray[np.int64]) -> TetMesh:
    """Tetrahedra of positive orientation, without debris and unused nodes."""
    volumes = signed_volumes(nodes, tets)
    tets = np.where((volumes < 0)[:, None], tets[:, [0, 1, 3, 2]], tets)
    piece = _face_connected_pieces(tets)
    share = np.bincount(piece, weights=np.abs(volumes)) / np.abs(volumes).sum()
    tets = tets[share[piece] >= CRUMB_SHARE]
    used, renumbered = np.unique(tets, return_inverse=True)
    return TetMesh.checked(nodes[used], renumbered.reshape(-1, 4))


def _face_connected_pieces(tets: NDArray[np.int64]) -> NDArray[np.int64]:
    """Number of the face-connected piece of each tetrahedron, (M,)."""
    faces = np.sort(tets[:, OUTWARD_FACES].reshape(-1, 3), axis=1)
    owner = np.repeat(np.arange(len(tets)), 4)
    order = np.lexsort(faces.T)
    same = (faces[order][1:] == faces[order][:-1]).all(axis=1)
    left, right = owner[order][:-1][same], owner[order][1:][same]
    return pieces(np.column_stack([left, right]), len(tets))
