"""The whole elimination against dense inverses and refined sparse solves, on awkward bodies."""

import numpy as np
import pytest
from awkward_bodies import block_of_cubes, inverse_at, joined, largest_column_error, oriented

from palpate.core.compliance.elimination import inverse, passed_loads
from palpate.core.compliance.elimination.surface_columns import factor_for_columns
from palpate.core.compliance.elimination.upper_tiles import UpperTiles
from palpate.core.compliance.elimination.work import Meter
from palpate.core.compliance.ordering.dissection import dissect
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.progress import unwatched
from palpate.core.stiffness.assembly import assemble


def lowest(mesh):
    return np.flatnonzero(mesh.nodes[:, 2] == mesh.nodes[:, 2].min())


def one_tetrahedron():
    mesh = oriented(np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 1, 2, 3]]))
    return mesh, np.array([0, 1, 2])


def thin_plate():
    mesh = block_of_cubes(14, 14, 1)
    return mesh, np.flatnonzero(mesh.nodes[:, 0] == 0)


def two_pieces():
    mesh = joined(block_of_cubes(4, 4, 4), block_of_cubes(2, 2, 2, origin=(1, 0, 0)))
    return mesh, lowest(mesh)


def a_piece_with_its_surface_pinned():
    mesh, fixed = two_pieces()
    first = np.flatnonzero(mesh.nodes[:, 0] < 0.5)
    return mesh, np.union1d(fixed, np.intersect1d(mesh.surface_nodes, first))


def pinned_inside():
    mesh = block_of_cubes(5, 5, 5)
    inside = np.setdiff1d(np.arange(len(mesh.nodes)), mesh.surface_nodes)
    return mesh, inside[::3]


def one_patch_to_touch():
    mesh = block_of_cubes(7, 7, 7)
    near = np.linalg.norm(mesh.nodes - mesh.nodes.max(axis=0), axis=1) < 0.025
    return mesh, np.setdiff1d(mesh.surface_nodes, np.flatnonzero(near))


def pins_across():
    mesh = block_of_cubes(12, 3, 3)
    return mesh, np.flatnonzero(np.abs(mesh.nodes[:, 0] - 0.06) < 1e-9)


BODIES = {
    make.__name__.replace("_", " "): make
    for make in (
        one_tetrahedron,
        thin_plate,
        two_pieces,
        a_piece_with_its_surface_pinned,
        pinned_inside,
        one_patch_to_touch,
        pins_across,
        paper_cube,
    )
}


@pytest.fixture(params=BODIES, ids=str)
def held_body(request):
    return BODIES[request.param]()


@pytest.fixture
def small_parts(monkeypatch):
    """Fronts and tiles so small that even a small body has many of each."""
    monkeypatch.setattr(dissect, "__defaults__", (8, unwatched))
    monkeypatch.setattr(UpperTiles.__init__, "__defaults__", (20,))
    monkeypatch.setattr(passed_loads, "PANEL", 30)
    monkeypatch.setattr(inverse, "TILE", 50)
    monkeypatch.setattr(inverse, "ROWS_RENUMBERED", 11)


@pytest.mark.parametrize(
    "poisson_ratio",
    [0.3, 0.4999, *(pytest.param(one, marks=pytest.mark.at_length) for one in (0.0, 0.49))],
)
def test_the_inverse_is_that_of_a_refined_solve(held_body, poisson_ratio):
    mesh, fixed = held_body
    stiffness = assemble(mesh, poisson_ratio)
    compliance = surface_compliance(mesh, stiffness, fixed, dtype=np.float64)
    true = inverse_at(stiffness, fixed, compliance.free_surface)
    found = compliance.table.reshape(len(true), -1)
    assert largest_column_error(found, true) < 1e-9
    single = surface_compliance(mesh, stiffness, fixed).table.reshape(len(true), -1)
    assert single.dtype == np.float32
    assert largest_column_error(single, true) < 6e-8


def test_small_fronts_and_tiles_give_the_same(held_body, small_parts):
    mesh, fixed = held_body
    stiffness = assemble(mesh, 0.45)
    compliance = surface_compliance(mesh, stiffness, fixed, dtype=np.float64)
    true = inverse_at(stiffness, fixed, compliance.free_surface)
    found = compliance.table.reshape(len(true), -1)
    assert largest_column_error(found, true) < 1e-11
    np.testing.assert_array_equal(found, found.T)


def test_a_single_node_to_touch_wherever_it_is():
    """Fronts without any load then lie below one whose loads begin on its own pivots."""
    mesh = block_of_cubes(7, 7, 7)
    stiffness = assemble(mesh, 0.3)
    for place in range(0, len(mesh.surface_nodes), 7):
        fixed = np.delete(mesh.surface_nodes, place)
        compliance = surface_compliance(mesh, stiffness, fixed, dtype=np.float64)
        true = inverse_at(stiffness, fixed, compliance.free_surface)
        assert largest_column_error(compliance.table.reshape(3, 3), true) < 1e-12


@pytest.mark.parametrize("poisson_ratio", [0.3, 0.49])
def test_a_body_with_many_fronts(mouse_mesh, poisson_ratio):
    mesh, fixed = mouse_mesh
    stiffness = assemble(mesh, poisson_ratio)
    compliance = surface_compliance(mesh, stiffness, fixed, dtype=np.float64)
    some = np.arange(0, compliance.node_count, 60)
    true = inverse_at(stiffness, fixed, compliance.free_surface[some])
    rows = (3 * some[:, None] + np.arange(3)).ravel()
    assert largest_column_error(compliance.columns(some)[rows], true) < 1e-10


def test_a_matrix_that_couples_more_than_tetrahedra_do():
    """The graph comes from the matrix: K + K K couples neighbours of neighbours."""
    mesh, fixed = paper_cube(0.05, 5)
    stiffness = assemble(mesh, 0.3)
    wider = (stiffness + stiffness @ stiffness).tocsr()
    compliance = surface_compliance(mesh, wider, fixed, dtype=np.float64)
    true = inverse_at(wider, fixed, compliance.free_surface)
    assert largest_column_error(compliance.table.reshape(len(true), -1), true) < 1e-10


def test_parts_without_a_common_front_do_not_move_each_other():
    mesh, fixed = pins_across()
    compliance = surface_compliance(mesh, assemble(mesh, 0.3), fixed)
    left = mesh.nodes[compliance.free_surface, 0] < 0.06
    across = compliance.table.reshape(len(left), 3, len(left), 3)[left][:, :, ~left]
    assert not across.any()


def test_columns_on_demand_are_the_tables(held_body):
    mesh, fixed = held_body
    stiffness = assemble(mesh, 0.3)
    table = surface_compliance(mesh, stiffness, fixed, dtype=np.float64)
    source = factor_for_columns(mesh, stiffness, fixed)
    np.testing.assert_array_equal(source.free_surface, table.free_surface)
    assert source.node_count == table.node_count
    order = np.random.default_rng(5).permutation(table.node_count)
    for nodes in (order, order[:1], order[: len(order) // 2 + 1]):
        found, expected = source.columns(nodes), table.columns(nodes)
        assert found.dtype == np.float64
        assert found.shape == expected.shape
        np.testing.assert_allclose(found, expected, atol=1e-13 * np.abs(expected).max())
    expected = table.diagonal()
    np.testing.assert_allclose(source.diagonal(), expected, atol=1e-13 * np.abs(expected).max())


def test_columns_take_less_memory_than_the_inverse(mouse_mesh):
    mesh, fixed = mouse_mesh
    source = factor_for_columns(mesh, assemble(mesh, 0.3), fixed)
    assert source.nbytes < 0.25 * 8 * (3 * source.node_count) ** 2


@pytest.mark.parametrize("count", [1, 2, 40])
def test_rows_and_columns_move_to_their_places(rng, count, small_parts):
    ranks = rng.permutation(count)
    table = rng.normal(size=(3 * count, 3 * count))
    places = (3 * ranks[:, None] + np.arange(3)).ravel()
    expected = np.empty_like(table)
    expected[np.ix_(places, places)] = table
    inverse._renumber(table, ranks, Meter(1.0, lambda _: None))
    np.testing.assert_array_equal(table, expected)
