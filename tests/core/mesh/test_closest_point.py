import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from palpate_servo import closest_points
from trimesh.triangles import closest_point as referee_closest_point

from palpate.core.mesh.closest_point import ClosestPoints, closest_area_coordinates


@settings(max_examples=50)
@given(st.integers(0, 2**32 - 1), st.sampled_from([2.0**-10, 1.0, 2.0**10]))
def test_closest_point_of_one_triangle_equals_an_independent_one(seed, scale):
    rng = np.random.default_rng(seed)
    corners, points = rng.normal(size=(64, 3, 3)), 2 * rng.normal(size=(64, 3))
    alpha = closest_area_coordinates(points * scale, corners * scale)
    ours = np.einsum("pc,pcx->px", alpha, corners)
    # The referee has absolute tolerances, so it is asked at size one.
    np.testing.assert_allclose(ours, referee_closest_point(corners, points), atol=1e-9)
    assert (alpha >= 0).all()
    np.testing.assert_allclose(alpha.sum(axis=1), 1)


def test_search_finds_what_brute_force_finds(mouse_mesh, rng):
    mesh, _ = mouse_mesh
    low, size = mesh.nodes.min(axis=0), np.ptp(mesh.nodes, axis=0)
    points = low + rng.random((200, 3)) * size * 1.5
    found = ClosestPoints(mesh.nodes, mesh.surface_triangles).query(points)
    corners = mesh.nodes[mesh.surface_triangles]
    for point, distance in zip(points, found.distance, strict=True):
        everywhere = referee_closest_point(corners, np.broadcast_to(point, (len(corners), 3)))
        assert abs(np.linalg.norm(everywhere - point, axis=1).min() - distance) < 1e-12


def test_triangles_of_very_different_size_do_not_confuse_the_search(rng):
    small = trimesh.creation.icosphere(subdivisions=2, radius=0.01)
    large = trimesh.creation.box((10, 10, 0.02))
    both = trimesh.util.concatenate([small, large])
    points = rng.normal(size=(100, 3)) * 0.03
    found = ClosestPoints(both.vertices, both.faces).query(points)
    corners = np.asarray(both.triangles)
    for point, distance in zip(points, found.distance, strict=True):
        everywhere = referee_closest_point(corners, np.broadcast_to(point, (len(corners), 3)))
        assert abs(np.linalg.norm(everywhere - point, axis=1).min() - distance) < 1e-12


def test_points_on_nodes_and_edges_have_exact_zeros(cube_mesh):
    mesh, _ = cube_mesh
    search = ClosestPoints(mesh.nodes, mesh.surface_triangles)
    at_nodes = search.query(mesh.nodes[mesh.surface_nodes])
    assert (np.sort(at_nodes.alpha, axis=1) == [0, 0, 1]).all()
    assert not at_nodes.distance.any()


def test_no_points_give_no_places(cube_mesh):
    mesh, _ = cube_mesh
    assert (
        len(ClosestPoints(mesh.nodes, mesh.surface_triangles).query(np.empty((0, 3))).triangle) == 0
    )


def test_the_compiled_search_finds_places_as_near(mouse, rng):
    """The other implementation as referee; ties may be of another triangle, never farther."""
    mesh = mouse.mesh
    points = mesh.nodes[rng.integers(0, len(mesh.nodes), 9000)] + rng.normal(0, 0.01, (9000, 3))
    points[:100] = mesh.nodes[mesh.surface_nodes[:100]]
    expected = ClosestPoints(mesh.nodes, mesh.surface_triangles).query(points)
    triangle, alpha = closest_points(mesh.nodes, mesh.surface_triangles, points)
    np.testing.assert_allclose(alpha.sum(axis=1), 1.0, atol=1e-12)
    assert alpha.min() >= 0.0
    places = np.einsum("pc,pcx->px", alpha, mesh.nodes[mesh.surface_triangles[triangle]])
    distance = np.linalg.norm(points - places, axis=1)
    np.testing.assert_allclose(distance, expected.distance, atol=1e-12)
    np.testing.assert_allclose(places, expected.position, atol=1e-9)


@pytest.mark.parametrize(
    ("nodes", "triangles", "points", "said"),
    [
        (np.eye(3), [[0, 1, 3]], np.eye(3), "names the node 3"),
        (np.eye(3), [[0, 1, -1]], np.eye(3), "names the node -1"),
        (np.eye(3), [[0, 1, 1]], np.eye(3), "no area"),
        (np.eye(3), np.empty((0, 3)), np.eye(3), "no triangles"),
        (np.full((3, 3), np.nan), [[0, 1, 2]], np.eye(3), "nodes has .* in row 0"),
        (np.eye(3), [[0, 1, 2]], np.full((3, 3), np.inf), "points has .* in row 0"),
    ],
)
def test_the_compiled_search_refuses_what_is_no_surface(nodes, triangles, points, said):
    with pytest.raises(ValueError, match=said):
        closest_points(nodes, triangles, points)


def test_the_compiled_search_takes_no_points():
    triangle, alpha = closest_points(np.eye(3), [[0, 1, 2]], np.empty((0, 3)))
    assert (triangle.shape, alpha.shape) == ((0,), (0, 3))
