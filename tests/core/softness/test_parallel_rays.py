import numpy as np
import pytest

from palpate.core.softness.parallel_rays import across, crossings


@pytest.mark.parametrize("direction", [[0, 0, -1.0], [1.0, 0, 0], [0.48, 0.6, 0.64]])
def test_the_frame_is_right_handed_and_square(direction):
    first, second = across(np.array(direction))
    np.testing.assert_allclose(np.cross(first, second), direction, atol=1e-12)
    assert first @ second == pytest.approx(0)


def test_lines_through_a_cube_enter_and_leave_it_once(cube_mesh, rng):
    mesh, _ = cube_mesh
    origins = np.column_stack([rng.uniform(0.001, 0.049, (200, 2)), np.full(200, 0.07)])
    # Through nodes and along edges as well: nothing slips through between triangles.
    origins[:25, :2] = np.indices((5, 5)).reshape(2, -1).T * 0.0125 * 0.98 + 0.0005
    met = crossings(mesh, origins, np.array([0.0, 0.0, -1.0]))
    entering = np.unique(met.lines[met.inward])
    assert entering.tolist() == list(range(200))
    np.testing.assert_allclose(met.heights[met.inward], 0.02, atol=1e-12)
    np.testing.assert_allclose(met.heights[~met.inward], 0.07, atol=1e-12)
    places = np.einsum("cn,cnx->cx", met.alphas, mesh.nodes[mesh.surface_triangles[met.triangles]])
    along = origins[met.lines] + met.heights[:, None] * [0, 0, -1]
    np.testing.assert_allclose(places, along, atol=1e-12)


def test_lines_beside_the_body_meet_nothing(cube_mesh):
    mesh, _ = cube_mesh
    met = crossings(mesh, np.array([[0.06, 0.02, 0.0]]), np.array([0.0, 0.0, 1.0]))
    assert len(met.lines) == 0


def test_an_oblique_line_meets_the_body_where_geometry_says(cube_mesh):
    mesh, _ = cube_mesh
    direction = np.array([0.6, 0.0, -0.8])
    met = crossings(mesh, np.array([[0.01, 0.021, 0.05]]), direction)
    assert met.heights[met.inward][0] == pytest.approx(0.0, abs=1e-12)
    # Down to the side at x = 0.05, before the base.
    assert met.heights[~met.inward][0] == pytest.approx(0.05 / 0.8)
