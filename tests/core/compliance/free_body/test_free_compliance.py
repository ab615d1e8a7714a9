"""Compliance of a body without pins."""

import numpy as np
import pytest
from referees.free_referee import FreeReferee

from palpate.core.compliance.elimination.surface_columns import factor_for_columns
from palpate.core.compliance.free_body import hold
from palpate.core.compliance.free_body.inertia import Inertia, RigidMotions
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import assemble

NO_PINS = np.empty(0, dtype=np.int64)


def free_compliance(mesh, poisson_ratio, dtype=np.float64, formulation="linear"):
    stiffness = assemble(mesh, poisson_ratio, formulation=formulation)
    return surface_compliance(mesh, stiffness, NO_PINS, dtype=dtype)


@pytest.fixture(scope="module")
def column():
    """One metre square, three high, at a height where its centre is not the origin."""
    cube, _ = paper_cube(1.0, 6)
    return TetMesh.checked(cube.nodes * [1.0, 1.0, 3.0] + [0.3, -0.2, 5.0], cube.tets)


@pytest.mark.parametrize("name", ["cube_mesh", "mouse_mesh"])
@pytest.mark.parametrize("poisson_ratio", [0.3, 0.49])
def test_displacements_are_those_of_a_free_finite_element_body(name, poisson_ratio, request, rng):
    mesh, _ = request.getfixturevalue(name)
    referee = FreeReferee(mesh, poisson_ratio)
    columns = factor_for_columns(mesh, assemble(mesh, poisson_ratio), NO_PINS)
    surface = columns.free_surface
    np.testing.assert_array_equal(surface, mesh.surface_nodes)
    few = np.sort(rng.choice(len(surface), 6, replace=False))
    loads = rng.standard_normal((len(few), 3))
    forces = np.zeros_like(mesh.nodes)
    forces[surface[few]] = loads
    moved = (columns.columns(few) @ loads.ravel()).reshape(-1, 3)
    expected = referee.displacements(forces)[surface]
    assert np.abs(moved - expected).max() < 1e-6 * np.abs(expected).max()


def test_the_table_is_what_single_columns_are(mouse_mesh):
    mesh, _ = mouse_mesh
    table = free_compliance(mesh, 0.3, np.float32)
    source = factor_for_columns(mesh, assemble(mesh, 0.3), NO_PINS)
    some = np.arange(0, table.node_count, 41)
    exact = source.columns(some)
    assert np.abs(table.columns(some) - exact).max() < 1e-7 * np.abs(exact).max()
    assert np.abs(table.diagonal() - source.diagonal()).max() < 1e-7 * np.abs(exact).max()
    rows = table.table.reshape(3 * table.node_count, -1)
    np.testing.assert_array_equal(rows, rows.T)


def test_the_choice_of_the_hold_makes_no_difference(cube_mesh, monkeypatch):
    mesh, _ = cube_mesh
    far = free_compliance(mesh, 0.45).table
    monkeypatch.setattr(hold, "_far_apart", lambda _: (60, 3, 17))
    near = free_compliance(mesh, 0.45).table
    assert np.abs(near - far).max() < 1e-9 * np.abs(far).max()
    assert not np.array_equal(near, far)


def test_no_force_gains_energy_and_the_hold_is_not_felt(cube_mesh):
    mesh, _ = cube_mesh
    table = free_compliance(mesh, 0.45).table
    assert np.linalg.eigvalsh(table.reshape(len(table) * 3, -1))[0] > 0.0
    # The cube is its own mirror image, which three nodes are not.
    places = mesh.nodes[mesh.surface_nodes].round(6)
    mirrored = np.lexsort((places * [-1.0, 1.0, 1.0] + [0.05, 0.0, 0.0]).round(6).T)
    straight = np.lexsort(places.T)
    own = np.einsum("jcjc->jc", table.reshape(len(table), 3, len(table), 3))
    np.testing.assert_allclose(own[mirrored], own[straight], rtol=1e-9)


def test_inertia_makes_no_displacement(cube_mesh):
    """P^T M R = 0: of a body without inner nodes the compliance takes M R to nothing."""
    mesh, _ = paper_cube(0.05, 1)
    assert len(mesh.surface_nodes) == len(mesh.nodes)
    compliance = free_compliance(mesh, 0.3)
    table = compliance.table.reshape(3 * compliance.node_count, -1)
    motions = RigidMotions.of(Inertia.of(mesh), mesh.nodes)
    assert np.abs(table @ motions.loads).max() < 1e-12 * np.abs(table).max()
    np.testing.assert_allclose(motions.modes.T @ motions.loads, np.eye(6), atol=1e-12)


def test_mass_centre_and_moments_of_a_fine_box_are_the_boxs(column):
    inertia = Inertia.of(column)
    assert inertia.volume == pytest.approx(3.0, rel=1e-12)
    np.testing.assert_allclose(inertia.centre, [0.8, 0.3, 6.5], rtol=1e-12)
    # Lumping adds what a cell's own corners spread: (1/6)^2 of the side, less with finer cells.
    about = np.array([1.0 + 9.0, 1.0 + 9.0, 2.0]) * 3.0 / 12.0
    np.testing.assert_allclose(np.diag(inertia.moments), about, rtol=0.06)


def test_a_column_that_stands_sags_and_bulges_as_linear_theory_says(column):
    """Weight rho g of a unit volume, E = 1: u_z = (z^2/2 - h z), free sides, smooth foot."""
    poisson_ratio, height = 0.3, 3.0
    compliance = free_compliance(column, poisson_ratio)
    rest = column.nodes[compliance.free_surface] - column.nodes.min(axis=0)
    foot, top = (np.flatnonzero(rest[:, 2] == level) for level in (0.0, height))
    down = 3 * foot + 2
    table = compliance.table.reshape(3 * len(rest), -1)
    inertia = Inertia.of(column)
    motions = inertia.modes(column.nodes[compliance.free_surface]).reshape(-1, 6)
    # Forces that keep the foot level and carry the weight: heave and two tilts move it.
    tilts = motions[down][:, [2, 3, 4]]
    held = np.block([[table[np.ix_(down, down)], tilts], [tilts.T, np.zeros((3, 3))]])
    known = np.concatenate([np.zeros(len(down)), [inertia.volume, 0.0, 0.0]])
    forces = np.linalg.solve(held, known)[: len(down)]
    moved = (table[:, down] @ forces).reshape(-1, 3)
    assert forces.sum() == pytest.approx(inertia.volume, rel=1e-6)
    sag = moved[top, 2].mean() - moved[foot, 2].mean()
    assert sag == pytest.approx(-0.5 * height**2, rel=0.02)
    # u_x = nu (h - z) x, at the foot as in the middle of the lowest layer of cells.
    assert np.ptp(moved[foot, 0]) == pytest.approx(poisson_ratio * (height - 0.25), rel=0.02)
    assert np.ptp(moved[top, 0]) < 0.1 * np.ptp(moved[foot, 0])


def test_pieces_that_would_part_are_refused(cube_mesh):
    mesh, _ = cube_mesh
    nodes = np.concatenate([mesh.nodes, mesh.nodes + np.array([0.2, 0, 0])])
    both = TetMesh.checked(nodes, np.concatenate([mesh.tets, mesh.tets + len(mesh.nodes)]))
    with pytest.raises(PalpateError, match=r"2 pieces.*join them"):
        free_compliance(both, 0.3)


def test_parts_that_swing_on_an_edge_are_refused(cube_mesh):
    mesh, _ = cube_mesh
    hinge = np.flatnonzero((mesh.nodes[:, 0] == 0.05) & (mesh.nodes[:, 2] == 0.05))
    turned = mesh.nodes * [-1.0, 1.0, -1.0] + [0.1, 0.0, 0.1]
    number = np.arange(len(mesh.nodes)) + len(mesh.nodes)
    number[hinge] = hinge
    tets = np.concatenate([mesh.tets, number[mesh.tets]])
    used, tets = np.unique(tets, return_inverse=True)
    nodes = np.concatenate([mesh.nodes, turned])[used]
    with pytest.raises(PalpateError, match="not held"):
        free_compliance(TetMesh.checked(nodes, tets.reshape(-1, 4)), 0.3)
