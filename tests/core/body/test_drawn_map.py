import numpy as np
import pytest
from palpate_servo import CubicPlaces

from palpate.core.body.drawn_map import DrawnMap


def test_vertices_on_nodes_move_as_the_nodes_do(body, rng):
    u = rng.normal(size=(body.compliance.node_count, 3))
    hung = DrawnMap.hang(body.mesh.nodes[body.compliance.free_surface], body)
    np.testing.assert_allclose(hung.displacements(u), u, atol=1e-6)


def test_an_array_that_is_kept_holds_the_last_frame_alone(body, rng):
    first, last = rng.normal(size=(2, body.compliance.node_count, 3))
    hung = DrawnMap.hang(body.mesh.nodes[body.mesh.surface_nodes], body)
    kept = np.full((len(body.mesh.surface_nodes), 3), np.nan, dtype=np.float32)
    for u in (first, last):
        assert hung.displacements(u, kept) is kept
    np.testing.assert_array_equal(kept, hung.displacements(last))


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
    np.testing.assert_allclose(hung.displacements(x), top * [1, 1, 0] + [0, 0, 0.05], atol=1e-8)


def test_a_smooth_dent_is_drawn_much_nearer_than_by_flat_triangles(mouse):
    """A dent of the size of some cells, at places within the triangles of the back."""
    mesh, middle = mouse.mesh, np.array([-0.027, -0.014, 0.057])

    def dent(places):
        return np.exp(-0.5 * np.sum((places - middle) ** 2, axis=1) / 0.02**2)[:, None] * [0, 0, 1]

    free = ~np.isin(mesh.surface_triangles, mouse.fixed).any(axis=1)
    corners = mesh.surface_triangles[free]
    places = np.einsum("c,tcx->tx", [0.5, 0.3, 0.2], mesh.nodes[corners])
    flat = np.einsum("c,tcx->tx", [0.5, 0.3, 0.2], dent(mesh.nodes.reshape(-1, 3))[corners])
    u = dent(mesh.nodes[mouse.compliance.free_surface])
    drawn = DrawnMap.hang(places, mouse).displacements(u)
    off_flat = np.linalg.norm(flat - dent(places), axis=1).mean()
    assert np.linalg.norm(drawn - dent(places), axis=1).mean() < 0.4 * off_flat


def test_no_seam_is_drawn_along_the_edges_of_triangles(mouse, rng):
    mesh = mouse.mesh
    u = rng.normal(size=(mouse.compliance.node_count, 3))
    ends = mesh.nodes[mesh.surface_triangles[:, :2]]
    apex = mesh.nodes[mesh.surface_triangles[:, 2]]
    on_edge = ends.mean(axis=1)
    hung = [
        DrawnMap.hang(on_edge + share * (apex - on_edge), mouse).displacements(u)
        for share in (0.0, 1e-6)
    ]
    np.testing.assert_allclose(hung[1], hung[0], atol=1e-4)


def test_vertices_of_triangles_far_from_pins_move_with_all_nodes(mouse):
    corners, fixed = mouse.mesh.surface_triangles, mouse.fixed
    beside_pins = np.unique(corners[np.isin(corners, fixed).any(axis=1)])
    inside = corners[~np.isin(corners, beside_pins).any(axis=1)]
    hung = DrawnMap.hang(mouse.mesh.nodes[inside].mean(axis=1), mouse)
    together = np.ones((mouse.compliance.node_count, 3))
    np.testing.assert_allclose(hung.displacements(together), 1, rtol=1e-6)


def test_many_vertices_move_as_the_same_few_do(mouse, rng):
    """Cores share the vertices where there are many; the order is that of the vertices."""
    corners = mouse.mesh.surface_triangles
    u = rng.normal(size=(mouse.compliance.node_count, 3))
    alpha = rng.dirichlet([1, 1, 1], size=200)
    places = np.einsum(
        "pc,pcx->px", alpha, mouse.mesh.nodes[corners[rng.integers(len(corners), size=200)]]
    )
    few = DrawnMap.hang(places, mouse).displacements(u)
    many = DrawnMap.hang(np.tile(places, (1000, 1)), mouse).displacements(u)
    np.testing.assert_array_equal(many, np.tile(few, (1000, 1)))


def test_places_in_cubic_patches_are_bernstein_sums(rng):
    """Against the algorithm of de Casteljau, in whatever order places come."""
    controls = rng.normal(size=(3, 10, 3))
    patches = rng.integers(3, size=41)
    alphas = rng.dirichlet([1, 1, 1], size=41)
    found = np.empty((41, 3), dtype=np.float32)
    CubicPlaces(patches, alphas, 3).write(controls, found)
    for patch, alpha, place in zip(patches, alphas, found, strict=True):
        np.testing.assert_allclose(place, bernstein_sum(controls[patch], alpha), atol=1e-6)


def bernstein_sum(controls, alpha):
    """Vector of a cubic patch at area coordinates."""
    powers = [(3, 0, 0), (0, 3, 0), (0, 0, 3), (2, 1, 0), (2, 0, 1)]
    powers += [(1, 2, 0), (0, 2, 1), (1, 0, 2), (0, 1, 2), (1, 1, 1)]
    level = dict(zip(powers, controls, strict=True))
    for degree in (2, 1, 0):
        at = [(i, j, degree - i - j) for i in range(degree + 1) for j in range(degree - i + 1)]
        level = {
            (i, j, k): alpha[0] * level[i + 1, j, k]
            + alpha[1] * level[i, j + 1, k]
            + alpha[2] * level[i, j, k + 1]
            for i, j, k in at
        }
    return level[0, 0, 0]


def test_a_place_in_a_patch_that_is_not_there_is_refused():
    for number in (-1, 2, 2**40):
        with pytest.raises(ValueError, match="a patch beyond the 2"):
            CubicPlaces([number], [[1, 0, 0]], 2)


def test_arrays_of_another_shape_are_refused():
    places = CubicPlaces([0], [[1, 0, 0]], 2)
    with pytest.raises(ValueError, match="patches has the shape"):
        places.write(np.zeros((1, 10, 3)), np.empty((1, 3), dtype=np.float32))
    with pytest.raises(ValueError, match="moved has the shape"):
        places.write(np.zeros((2, 10, 3)), np.empty((2, 3), dtype=np.float32))
