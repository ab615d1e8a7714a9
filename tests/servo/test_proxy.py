"""The god object from Python: on the stored mouse, against brute force."""

from pathlib import Path

import numpy as np
import pytest
from palpate_servo import Body, Proxy

MOUSE = Path(__file__).resolve().parents[1] / "meshes" / "mouse-1.7k.npz"
FACES_OF_A_TET = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


@pytest.fixture(scope="module")
def mouse():
    """The boundary of the stored tets, oriented outwards."""
    with np.load(MOUSE) as file:
        nodes, tets = file["X"], file["T"].astype(np.int64)
    a, b, c, d = (nodes[tets[:, k]] for k in range(4))
    left_handed = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets[left_handed] = tets[left_handed][:, [0, 2, 1, 3]]
    faces = tets[:, FACES_OF_A_TET].reshape(-1, 3)
    _, first, count = np.unique(np.sort(faces), axis=0, return_index=True, return_counts=True)
    boundary = faces[first[count == 1]]
    used, triangles = np.unique(boundary, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    body = Body(nodes[used], triangles, np.tile(np.eye(3), (len(used), 1, 1)))
    return nodes[used], triangles, body


def nearest_on_triangles(p, corners):
    """Distances from p to triangles (m, 3, 3), by planes and edges."""
    a, b, c = corners.swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    height = np.einsum("ij,ij->i", p - a, normal)
    foot = p - height[:, None] * normal
    inside = np.ones(len(corners), bool)
    best = np.full(len(corners), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        along = end - start
        inside &= np.einsum("ij,ij->i", np.cross(along, foot - start), normal) >= 0
        part = np.einsum("ij,ij->i", p - start, along) / np.einsum("ij,ij->i", along, along)
        on_edge = start + np.clip(part, 0, 1)[:, None] * along
        best = np.minimum(best, np.linalg.norm(p - on_edge, axis=1))
    return np.where(inside, np.abs(height), best)


def winding_number(p, corners):
    """1 inside, 0 outside (van Oosterom and Strackee 1983)."""
    r = corners - p
    length = np.linalg.norm(r, axis=2)
    a, b, c = r.swapaxes(0, 1)
    below = length.prod(axis=1) + sum(
        np.einsum("ij,ij->i", r[:, i], r[:, j]) * length[:, k]
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    )
    above = np.einsum("ij,ij->i", a, np.cross(b, c))
    return np.arctan2(above, below).sum() / (2 * np.pi)


def pushes(nodes, triangles, count, rng):
    """Ways in and out along the normals, through triangles, edges and nodes."""
    for number in range(count):
        corners = nodes[triangles[rng.integers(len(triangles))]]
        alpha = rng.dirichlet([1, 1, 1])
        alpha[rng.permutation(3)[: number % 3]] = 0
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        normal /= np.linalg.norm(normal)
        goal = alpha / alpha.sum() @ corners
        quantum = (1e-6, 1e-5, 2e-5, 5e-5, 6e-5)[number % 5]
        depth = np.linspace(-0.001, 0.003, int(rng.integers(20, 200)))
        way = np.concatenate([depth, depth[::-1]])
        yield quantum * np.round((goal - way[:, None] * normal) / quantum)


def test_pushes_into_the_mouse_never_fall_through(mouse):
    nodes, triangles, body = mouse
    corners = nodes[triangles]
    rng = np.random.default_rng(2346)
    pushed = 0
    for path in pushes(nodes, triangles, 1500, rng):
        if body.closest_point(path[0])[3] <= 0:
            continue
        proxy = Proxy(body)
        positions, touched = proxy.follow_path(path)
        free = touched < 0
        np.testing.assert_array_equal(positions[free], path[free])
        deepest = len(path) // 2
        for device in path[free][:: max(1, int(free.sum()) // 4)]:
            if nearest_on_triangles(device, corners).min() > 1e-12:
                assert winding_number(device, corners) < 0.5
        if not free[deepest]:
            pushed += 1
    assert pushed > 1000


def test_the_held_proxy_is_locally_nearest(mouse):
    nodes, triangles, body = mouse
    rng = np.random.default_rng(7)
    held = 0
    for path in pushes(nodes, triangles, 300, rng):
        if body.closest_point(path[0])[3] <= 0:
            continue
        proxy = Proxy(body)
        positions, touched = proxy.follow_path(path)
        deepest = len(path) // 2
        if touched[deepest] < 0:
            continue
        held += 1
        position, device = positions[deepest], path[deepest]
        here = nearest_on_triangles(position, nodes[triangles]) < 1e-12
        around = nearest_on_triangles(device, nodes[triangles[here]])
        assert np.linalg.norm(device - position) ** 2 - around.min() ** 2 <= 1e-14
    assert held > 100


def test_force_is_nothing_at_touch_and_at_release(cube):
    proxy = Proxy(cube.native)
    proxy.restart([0.02, 0.03, 0.06])
    for height in [1e-3, 1e-9, 0.0]:
        _, position, _, _ = proxy.move([0.02, 0.03, 0.05 + height])
        np.testing.assert_allclose(position, [0.02, 0.03, 0.05 + height], atol=1e-17)
    for depth in [1e-9, 1e-6, 1e-3, 1e-6, 1e-9]:
        touching, position, _, _ = proxy.move([0.02, 0.03, 0.05 - depth])
        assert touching
        np.testing.assert_allclose(position, [0.02, 0.03, 0.05], atol=1e-16)
    touching, position, triangle, alpha = proxy.move([0.02, 0.03, 0.05 + 1e-9])
    assert (touching, triangle) == (False, -1)
    assert not alpha.any()


def test_on_a_node_the_area_coordinates_are_exact(cube):
    proxy = Proxy(cube.native)
    proxy.restart([0.025, 0.025, 0.06])
    _, position, triangle, alpha = proxy.move([0.025, 0.025, 0.045])
    np.testing.assert_array_equal(position, [0.025, 0.025, 0.05])
    assert sorted(alpha) == [0.0, 0.0, 1.0]
    node = cube.triangles[triangle][int(np.argmax(alpha))]
    np.testing.assert_array_equal(cube.nodes[node], position)


def test_a_position_that_is_not_finite_is_refused(cube):
    proxy = Proxy(cube.native)
    with pytest.raises(ValueError, match="not finite"):
        proxy.move([0.0, np.nan, 0.0])
