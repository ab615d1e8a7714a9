"""A body on a lattice: even strains exactly, turns for nothing, pins held, nothing floppy."""

import numpy as np
import pytest

from palpate.core.law.of_material import law_of
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.lattice.coarse_solid import CoarseSolid
from palpate.core.shape.lattice.lattice import Lattice
from palpate.core.shape.solid.solid import solid

NO_PINS = np.empty(0, dtype=np.int64)


@pytest.fixture(scope="module")
def wedge():
    """A body that fills its cubes in part: a cube pressed to a wedge."""
    mesh, fixed = paper_cube(1.0, 5)
    nodes = mesh.nodes.copy()
    nodes[:, 1] *= 0.2 + 0.8 * nodes[:, 2]
    return TetMesh.checked(nodes, mesh.tets), fixed


@pytest.mark.parametrize("poisson_ratio", [0.49, 0.3, 0.0, -0.4])
def test_evenly_strained_bodies_have_their_energy(wedge, poisson_ratio):
    mesh, _ = wedge
    young_scale = np.where(mesh.nodes[mesh.tets].mean(axis=1)[:, 0] > 0.5, 3.0, 1.0)
    lattice = Lattice.around(mesh, 0.23)
    coarse = CoarseSolid.of(lattice, mesh, NO_PINS, poisson_ratio, young_scale)
    slopes = np.array([[0.1, 0.3, 0.0], [-0.2, -0.1, 0.1], [0.0, 0.2, 0.05]])
    found = coarse.solid.energy(lattice.positions @ slopes.T)
    expected = solid(mesh, poisson_ratio, law_of(poisson_ratio), young_scale=young_scale).energy(
        mesh.nodes @ slopes.T
    )
    # Above the body by what parts are filled with at least.
    assert found == pytest.approx(expected, rel=5e-3)


def test_turning_costs_nothing_and_moves_no_spring(wedge):
    mesh, _ = wedge
    lattice = Lattice.around(mesh, 0.23)
    coarse = CoarseSolid.of(lattice, mesh, NO_PINS, 0.3)
    turn = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
    moved = lattice.positions @ turn.T - lattice.positions + [1.0, 2.0, 3.0]
    bent = lattice.positions[:, :1] * lattice.positions
    scale = coarse.solid.energy(bent)
    assert abs(coarse.solid.energy(moved)) < 1e-12 * scale
    pull = np.abs(coarse.springs @ moved).max()
    assert pull < 1e-9 * np.abs(coarse.springs @ bent).max()


@pytest.mark.parametrize("edge", [0.6, 0.3, 0.15])
@pytest.mark.parametrize("poisson_ratio", [0.49, -0.4])
def test_no_displacement_is_free_but_six(wedge, edge, poisson_ratio):
    mesh, fixed = wedge
    lattice = Lattice.around(mesh, edge)
    loose, held = (
        np.linalg.eigvalsh(CoarseSolid.of(lattice, mesh, pins, poisson_ratio).stiffness.toarray())
        for pins in (NO_PINS, fixed)
    )
    assert np.abs(loose[:6]).max() < 1e-10 * loose[-1]
    assert loose[6] > 1e-9 * loose[-1]
    assert held[0] > 1e-9 * loose[-1]


def test_a_bent_bar_one_cube_thick_is_about_as_stiff_as_it_is():
    mesh, _ = paper_cube(1.0, 6)
    nodes = mesh.nodes * [1.0, 0.2, 0.2]
    bar = TetMesh.checked(nodes, mesh.tets)
    fixed = np.flatnonzero(nodes[:, 0] == 0.0)
    end = np.flatnonzero(nodes[:, 0] == 1.0)
    lattice = Lattice.around(bar, 0.2)
    coarse = CoarseSolid.of(lattice, bar, fixed, 0.3)
    taken = lattice.interpolation(nodes[end], lattice.node_parts[end])
    forces = taken.T @ np.tile([0.0, 0.0, 1.0 / len(end)], (len(end), 1))
    moved = np.linalg.solve(coarse.stiffness.toarray(), forces.ravel()).reshape(-1, 3)
    sag = (taken @ moved)[:, 2].mean()
    # Timoshenko's bar of width b at a modulus of 1: 4 L^3 / b^4, and shear.
    expected = 4.0 / 0.2**4 + 2 * 1.3 / (5 / 6) / 0.2**2
    assert 0.7 < sag / expected < 1.3
