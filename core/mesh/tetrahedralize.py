"""Tetrahedralization of a surface by fTetWild.

fTetWild cannot be interrupted and writes files into the working directory, so this is meant to run
in the child process of :mod:`..bake.job`, inside a temporary folder.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from ..machine.absent_library import library
from .coordinates import UnitBox, along_z_curve
from .fit import THICKNESS_DOUBTFUL, refuse_thin
from .surface import Surface
from .tet_mesh import OUTWARD_FACES, TetMesh, pieces, signed_volumes

# Face-connected pieces below this share of the volume are debris of the envelope, not parts.
CRUMB_SHARE = 1e-3
# Passes that improve tetrahedra. Most shapes end by themselves after 4 to 8; where parts cross, as
# in Suzanne, it goes on to no better ones: worst energy 12 after 10 passes, 31 after the 14 that it
# took for itself. Without a limit a rabbit with fine edges took 100 s, and 21 for as many nodes.
MOST_PASSES = 10


def tetrahedralize(surface: Surface, edge_length: float, epsilon: float) -> TetMesh:
    """Fill a surface with tetrahedra.

    fTetWild gets the surface centred and with a diagonal of 1: it compares with lengths that do
    not depend on the size, so that the unit and the origin would change its result. Its triangles
    are put into an order in space: it searches them by a tree of boxes that halves the list as it
    is given, and took up to five times as long where neighbours were far apart in it.

    Parameters
    ----------
    surface : may be open, overlapping, or in several parts.
    edge_length : wanted length of edges, as a share of the bounding box diagonal.
    epsilon : how far the body's surface may lie from the input's, as such a share.

    Raises
    ------
    PalpateError
        The surface encloses nothing that fTetWild could fill, or is too thin for the tolerance;
        or there is no fTetWild for this system.
    """
    ftetwild = library("pytetwild.pytetwild", "fTetWild").tetrahedralize
    refuse_thin(surface, epsilon)
    box = UnitBox.of(surface.vertices)
    vertices = box.enter(surface.vertices)
    order = along_z_curve(vertices[surface.triangles].mean(axis=1))
    nodes, tets = ftetwild(
        vertices,
        surface.triangles[order].astype(np.int32),
        edge_length_fac=edge_length,
        epsilon=epsilon,
        num_opt_iter=MOST_PASSES,
        quiet=False,
        loglevel=2,
    )
    if not len(tets):
        refuse_thin(surface, epsilon, THICKNESS_DOUBTFUL)
        raise PalpateError(
            "tetrahedralization: the surface encloses no volume; close its holes, give sheets "
            "thickness (Solidify), or recalculate its normals to point outside"
        )
    mesh = _cleaned(np.asarray(nodes, dtype=np.float64), np.asarray(tets, dtype=np.int64))
    return TetMesh.checked(box.leave(mesh.nodes), mesh.tets)


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
