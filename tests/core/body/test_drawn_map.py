import numpy as np

from palpate.core.body.drawn_map import DrawnMap


def test_vertices_on_nodes_move_as_the_nodes_do(body, rng):
    u = rng.normal(size=(body.compliance.node_count, 3))
    hung = DrawnMap.hang(body.mesh.nodes[body.compliance.free_surface], body)
    np.testing.assert_allclose(hung.displacements(u), u, atol=1e-12)


def test_pinned_vertices_do_not_move(body, rng):
    u = rng.normal(size=(body.compliance.node_count, 3))
    surface_pins = np.intersect1d(body.fixed, body.mesh.surface_nodes)
    hung = DrawnMap.hang(body.mesh.nodes[surface_pins], body)
    np.testing.assert_allclose(hung.displacements(u), 0, atol=1e-12)


def test_vertices_off_the_surface_move_as_the_nearest_place(cube):
    """A displacement linear in position is reproduced on the surface below."""
    x = cube.mesh.nodes[cube.compliance.free_surface]
    top = np.array([[0.021, 0.013, 0.052], [0.04, 0.033, 0.051]])
    hung = DrawnMap.hang(top, cube)
    np.testing.assert_allclose(hung.displacements(x), top * [1, 1, 0] + [0, 0, 0.05], atol=1e-12)


def test_weights_of_a_vertex_sum_to_one_where_nothing_is_pinned(mouse, rng):
    free = ~np.isin(mouse.mesh.surface_triangles, mouse.fixed).any(axis=1)
    centres = mouse.mesh.nodes[mouse.mesh.surface_triangles[free]].mean(axis=1)
    weights = DrawnMap.hang(centres, mouse).weights
    np.testing.assert_allclose(weights.sum(axis=1), 1)
    assert weights.nnz == 3 * len(centres)
