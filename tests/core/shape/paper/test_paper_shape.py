"""The shape of (16): its tables around the touched place, kept and taken over again."""

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.errors import CancelledError
from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.paper.paper_shape import PaperShape
from palpate.core.shape.paper.paper_table import KIND, PaperTable
from palpate.core.shape.paper.table_file import TableFileError, table_path
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium

MODULUS = 5_000.0


@pytest.fixture(scope="module")
def cube():
    return baked_body(*paper_cube(cells=2), young_modulus=MODULUS)


@pytest.fixture(scope="module")
def corner(cube):
    return np.array([np.argmax(cube.mesh.nodes.sum(axis=1))])


def test_under_the_largest_force_the_shape_is_newtons(cube, corner):
    shape = PaperShape(cube, wanted=1e-5)
    try:
        shape.wait_for(corner)
        assert shape.ready == 1.0
        force = np.array([[0.0, 1e-5 * MODULUS, 0.0]])
        found = shape.displacements(corner, force)
    finally:
        shape.close()
    solid = FreeSolid.of(cube, StVenantKirchhoff())
    u = equilibrium(solid, solid.on_free_nodes(corner, force / MODULUS)).displacements
    expected = u[solid.surface]
    size = np.abs(expected).max()
    assert np.abs(found - expected).max() < 2e-4 * size
    assert np.abs(cube.deform(corner, force) - expected).max() > 0.02 * size


def test_what_is_not_there_yet_is_linear_and_comes(cube, corner, eventually):
    shape = PaperShape(cube)
    force = np.array([[0.05, 0.0, 0.0]])
    try:
        linear = cube.deform(corner, force)
        first = shape.displacements(corner, force)
        assert np.array_equal(first, linear) or shape.ready == 1.0
        eventually(lambda: shape.displacements(corner, force) is not None and shape.ready == 1.0)
        assert not np.allclose(shape.displacements(corner, force), linear, rtol=1e-3)
    finally:
        shape.close()


def test_other_nodes_stay_linear_beside_a_known_one(cube, corner):
    table = PaperTable(cube)
    known = cube.free_index(corner)
    table.fill(known)
    shape = PaperShape(cube)
    shape.close()
    shape.table.positive.update(table.positive)
    shape.table.negative.update(table.negative)
    shape.table.largest[:] = table.largest
    shape.table.is_filled[known] = True
    other = cube.compliance.free_surface[[0]]
    both, forces = np.append(corner, other), np.array([[0.0, 0.1, 0.0], [0.0, 0.0, 0.2]])
    alone = shape.displacements(corner, forces[:1]) + cube.deform(other, forces[1:])
    assert np.allclose(shape.displacements(both, forces), alone, rtol=0, atol=1e-12)
    # Forces on one node that come twice add up before they are squared.
    twice = shape.displacements(np.append(corner, corner), 0.5 * forces[[0, 0]])
    assert np.allclose(twice, shape.displacements(corner, forces[:1]), rtol=0, atol=1e-12)


def test_a_table_is_kept_beside_the_body_and_taken_over(cube, corner, tmp_path):
    body_file = tmp_path / "cube.npz"
    first = PaperShape(cube, body_file)
    first.wait_for(corner)
    first.close()
    path = table_path(body_file, KIND)
    again = PaperShape(cube, body_file)
    try:
        known = cube.free_index(corner)
        assert again.table.is_filled[known].all()
        assert not again.notice
        node = int(known[0])
        assert np.array_equal(again.table.positive[node], first.table.positive[node])
        assert np.array_equal(again.table.negative[node], first.table.negative[node])
        assert np.array_equal(again.table.largest[known], first.table.largest[known])
    finally:
        again.close()
    with pytest.raises(TableFileError, match="another F0"):
        PaperTable(cube, 1e-5).load(path)
    path.write_bytes(path.read_bytes()[:-200])
    damaged = PaperShape(cube, body_file)
    damaged.close()
    assert str(path) in damaged.notice
    assert not damaged.table.is_filled.any()


def test_a_cancelled_table_ends_and_leaves_the_node_empty(cube):
    table = PaperTable(cube)
    table.cancel()
    with pytest.raises(CancelledError):
        table.fill(np.array([3]))
    assert not table.is_filled.any()


def test_three_tables_take_three_times_the_memory_once_all_is_filled(cube, corner):
    table = PaperTable(cube)
    assert table.nbytes == table.largest.nbytes
    table.fill(cube.free_index(corner))
    a_node = table.nbytes - table.largest.nbytes
    assert a_node * cube.compliance.node_count == 2 * cube.compliance.nbytes


def test_a_place_that_cannot_be_written_is_told_and_the_shape_is_there(cube, corner, tmp_path):
    (tmp_path / "file").write_text("")
    shape = PaperShape(cube, tmp_path / "file" / "cube.npz", wanted=1e-6)
    shape.wait_for(corner)
    assert shape.notice == ""
    shape.close()
    assert "cannot be written" in shape.notice
    assert shape.ready == 1.0


def test_what_another_program_kept_meanwhile_is_not_lost(cube, corner, tmp_path):
    body_file = tmp_path / "cube.npz"
    opposite = np.array([cube.compliance.free_surface[0]])
    shapes = [PaperShape(cube, body_file, wanted=1e-6) for _ in range(2)]
    for shape, node in zip(shapes, (corner, opposite), strict=True):
        shape.wait_for(node)
    for shape in shapes:
        shape.close()
    kept = PaperTable(cube, 1e-6)
    kept.load(table_path(body_file, KIND))
    assert kept.is_filled[cube.free_index(np.append(corner, opposite))].all()
