import numpy as np
import pytest

from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import assemble


def test_the_cubes_compliance_has_the_papers_size(cube_mesh):
    mesh, fixed = cube_mesh
    compliance = surface_compliance(mesh, assemble(mesh, 0.49), fixed, dtype=np.float64)
    assert compliance.table.shape == (73, 3, 219)
    assert compliance.table.nbytes == 383_688


def test_compliance_is_symmetric(body):
    full = body.compliance.table.reshape(3 * body.compliance.node_count, -1)
    np.testing.assert_array_equal(full, full.T)


def test_blocks_diagonal_and_columns_agree(body, rng):
    compliance = body.compliance
    i, j = rng.integers(0, compliance.node_count, 2)
    np.testing.assert_array_equal(compliance.block(i, i), compliance.diagonal()[i])
    np.testing.assert_array_equal(compliance.block(i, j), compliance.block(j, i).T)
    force = rng.normal(size=3)
    moved = compliance.apply(force[None], np.array([j]))
    largest = np.abs(moved).max()
    np.testing.assert_allclose(moved[i], compliance.block(i, j) @ force, atol=3e-7 * largest)


@pytest.mark.parametrize(("dtype", "error"), [(np.float32, 1e-6), (np.float64, 1e-14)])
@pytest.mark.parametrize("count", [0, 1, 3, 32, 33, 73])
def test_displacements_are_the_product_with_the_columns(cube_mesh, rng, dtype, error, count):
    mesh, fixed = cube_mesh
    compliance = surface_compliance(mesh, assemble(mesh, 0.49), fixed, dtype=dtype)
    compliance.table.setflags(write=False)
    nodes, forces = rng.permutation(73)[:count], rng.normal(size=(count, 3))
    expected = compliance.columns(nodes) @ forces.ravel()
    moved = compliance.apply(forces, nodes)
    assert moved.shape == (73, 3)
    assert moved.dtype == np.float64
    largest = np.abs(compliance.columns(nodes)).max(initial=0.0) * max(count, 1)
    np.testing.assert_allclose(moved.ravel(), expected, rtol=0, atol=error * largest)


def test_without_nodes_every_node_is_loaded(cube, rng):
    forces = rng.normal(size=(73, 3))
    everywhere = cube.compliance.apply(forces, np.arange(73))
    np.testing.assert_array_equal(cube.compliance.apply(forces), everywhere)


def test_a_bar_under_tension_stretches_as_the_closed_form_says():
    """Poisson's ratio 0: u = F l / (E A), and linear tetrahedra are exact for uniform strain."""
    mesh, fixed = paper_cube(0.1, 3)
    compliance = surface_compliance(mesh, assemble(mesh, 0.0), fixed, dtype=np.float64)
    top = np.flatnonzero(mesh.nodes[:, 2] == mesh.nodes[:, 2].max())
    triangles = mesh.surface_triangles
    on_top = triangles[np.isin(triangles, top).all(axis=1)]
    corners = mesh.nodes[on_top]
    area = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    load = np.zeros((len(mesh.nodes), 3))
    np.add.at(load[:, 2], on_top.ravel(), np.repeat(area / 3, 3))
    loaded = compliance.free_surface
    moved = compliance.apply(load[loaded])
    expected = np.zeros_like(moved)
    expected[:, 2] = mesh.nodes[loaded, 2]
    np.testing.assert_allclose(moved, expected, atol=1e-12)


@pytest.mark.parametrize("fixed", [[0], [0, 1], [0, 1, 2, 3, 4]])
def test_pins_that_do_not_hold_the_body_are_refused(cube_mesh, fixed):
    mesh, _ = cube_mesh  # nodes 0 to 4 lie on one edge
    with pytest.raises(PalpateError, match="could move away"):
        surface_compliance(mesh, assemble(mesh, 0.3), np.array(fixed, dtype=int))


def test_a_piece_without_pins_is_named(cube_mesh):
    mesh, fixed = cube_mesh
    both = TetMesh.checked(
        np.vstack([mesh.nodes, mesh.nodes + 1]), np.vstack([mesh.tets, mesh.tets + 125])
    )
    with pytest.raises(PalpateError, match="piece 2"):
        surface_compliance(both, assemble(both, 0.3), fixed)


def test_everything_pinned_is_refused(cube_mesh):
    mesh, _ = cube_mesh
    with pytest.raises(PalpateError, match="nothing is left to touch"):
        surface_compliance(mesh, assemble(mesh, 0.3), mesh.surface_nodes)
