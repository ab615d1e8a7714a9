"""Tetrahedra in pieces: nothing of volume, middle or second moment is lost."""

import numpy as np
import pytest

from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.lattice.tet_samples import MOST_CUTS, TetSamples

TETS = TetMesh.checked(
    np.array([[0, 0, 0], [1.0, 0.1, 0], [0, 0.8, 0], [0.2, 0, 0.7], [-0.1, -0.2, -3.0]]),
    np.array([[0, 1, 2, 3], [0, 2, 1, 4]]),
)


@pytest.mark.parametrize("length", [10.0, 0.9, 0.2])
def test_pieces_make_up_the_whole(length):
    samples = TetSamples.of(TETS, length)
    corners = TETS.nodes[TETS.tets]
    for tet, volume in enumerate(TETS.tet_volumes):
        own = samples.tets == tet
        assert samples.volumes[own].sum() == pytest.approx(volume)
        middle = corners[tet].mean(axis=0)
        np.testing.assert_allclose(samples.points[own].mean(axis=0), middle, atol=1e-12)
        squares = ((samples.points[own] - middle) ** 2).sum(axis=1)
        moment = samples.volumes[own] @ squares + samples.moments[own].sum()
        expected = volume / 20 * ((corners[tet] - middle) ** 2).sum()
        assert moment == pytest.approx(expected, rel=1e-9)


def test_long_ones_are_cut_until_they_are_short():
    counts = [np.bincount(TetSamples.of(TETS, length).tets) for length in (10.0, 1.7, 0.9, 1e-9)]
    assert counts[0].tolist() == [1, 1]
    assert counts[1].tolist() == [1, 8]
    assert counts[2].tolist() == [8, 64]
    assert counts[3].tolist() == [8**MOST_CUTS] * 2
