"""The god object from Python: on the stored mouse, against brute force."""

import numpy as np
import pytest
from bodies.golden_sphere import golden_sphere
from palpate_servo import Body
from palpate_servo.harness import Proxy

from palpate.core.mesh.surface import Surface
from palpate.core.mesh.winding_volume import is_inside

# A contact point has come to its god object by then: ticks of 1 ms, time constant 5 ms.
TICKS_TO_ARRIVE = 60


@pytest.fixture(scope="module")
def mouse(mouse_mesh):
    mesh, _ = mouse_mesh
    nodes, triangles = mesh.nodes[mesh.surface_nodes], mesh.surface_local_triangles
    return nodes, triangles, Body(nodes, triangles, np.tile(np.eye(3), (len(nodes), 1, 1)))


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


@pytest.mark.at_length
def test_pushes_into_the_mouse_never_fall_through_and_are_held_locally_nearest(mouse):
    nodes, triangles, body = mouse
    surface = Surface(nodes, triangles)
    held = 0
    for path in pushes(nodes, triangles, 500, np.random.default_rng(7)):
        if body.closest_point(path[0])[3] <= 0:
            continue
        proxy, deepest = Proxy(body), len(path) // 2
        positions, touched = proxy.follow_path(path)
        free = touched < 0
        np.testing.assert_array_equal(positions[free], path[free])
        looked_at = path[free][:: max(1, int(free.sum()) // 4)]
        off_surface = [nearest_on_triangles(p, nodes[triangles]).min() > 1e-12 for p in looked_at]
        assert not is_inside(looked_at[off_surface], surface).any()
        if free[deepest]:
            continue
        held += 1
        device = path[deepest]
        proxy.restart(path[0])
        proxy.follow_path(path[: deepest + 1])
        position = proxy.follow_path(np.tile(device, (TICKS_TO_ARRIVE, 1)))[0][-1]
        here = nearest_on_triangles(position, nodes[triangles]) < 1e-12
        around = nearest_on_triangles(device, nodes[triangles[here]])
        assert np.linalg.norm(device - position) ** 2 - around.min() ** 2 <= 1e-14
    assert held > 330


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
    with pytest.raises(ValueError, match="must be finite"):
        proxy.move([0.0, np.nan, 0.0])


def great_circles(count, step):
    """Directions (count, 3) along tilted circles, ``step`` rad apart."""
    angle = step * np.arange(count)
    tilt = 0.5 * np.sin(0.137 * angle)
    return np.stack(
        [np.cos(angle) * np.cos(tilt), np.sin(angle) * np.cos(tilt), np.sin(tilt)], axis=1
    )


# The ideal sphere's own force turns by 0.0125 N a tick; a plain god object's jumps by 0.17 N more.
@pytest.mark.parametrize(("shading", "most"), [(False, 0.05), (True, 0.01)])
def test_sliding_deep_under_a_faceted_sphere_the_force_is_smooth(shading, most):
    radius, depth, stiffness = 0.025, 0.005, 500.0
    nodes, triangles = golden_sphere(1175, radius)
    assert len(triangles) == 2346
    body = Body(nodes, triangles, np.tile(np.eye(3), (len(nodes), 1, 1)))
    # 100 mm/s at 1 kHz.
    out = great_circles(10_000, 1e-4 / (radius - depth))
    path = (radius - depth) * out
    proxy = Proxy(body, shading=shading)
    way_in = np.linspace(1.5, 1.0, 100)[:, None] * path[0]
    proxy.restart(way_in[0])
    proxy.follow_path(way_in)
    points, touched = proxy.follow_path(path)
    assert (touched >= 0).all()
    jumps = np.linalg.norm(np.diff(stiffness * (points - path), axis=0), axis=1)
    ideal = np.linalg.norm(np.diff(stiffness * depth * out, axis=0), axis=1)
    assert np.percentile(jumps - ideal, 99) < most
    # And it is the sphere's: about as strong, and towards it.
    np.testing.assert_allclose(np.linalg.norm(points - path, axis=1), depth, atol=3e-4)


def finger_force(body, blocks, device, touched):
    """(14) for displacements of contact points, at 1 Pa: force (3,) and the contact's normal."""
    nodes, triangles = body
    triangle, alpha, point = touched
    force = np.zeros(3)
    for node, share in zip(triangles[triangle], alpha, strict=True):
        force -= share * blocks[node] @ (device - point)
    a, b, c = nodes[triangles[triangle]]
    normal = np.cross(b - a, c - a)
    return force, normal / np.linalg.norm(normal)


def test_slipping_over_the_mouse_its_force_lies_on_the_cone(mouse):
    nodes, triangles, _ = mouse
    rng = np.random.default_rng(5)
    factors = rng.normal(size=(len(nodes), 3, 3))
    # Up to some tens of per cent stiffer one way than another, and different from node to node.
    blocks = np.eye(3) + 0.05 * (factors @ factors.swapaxes(1, 2))
    body = Body(nodes, triangles, blocks)
    slipped, on_cone = 0, 0
    for triangle in rng.choice(len(triangles), 60, replace=False):
        corners = nodes[triangles[triangle]]
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        normal /= np.linalg.norm(normal)
        middle = corners.mean(axis=0)
        if body.closest_point(middle + 1e-3 * normal)[3] < 5e-4:
            continue
        along = np.cross(normal, rng.normal(size=3))
        along *= 5e-6 / np.linalg.norm(along)
        proxy = Proxy(body, static_friction=0.5, dynamic_friction=0.3)
        for depth in np.linspace(-1e-3, 1e-3, 50):
            proxy.move(middle - depth * normal)
        for step in range(150):
            device = middle - 1e-3 * normal + step * along
            touching, point, number, alpha = proxy.move(device)
            if not touching:
                break
            if proxy.sticking or not alpha.all():
                continue
            force, out = finger_force((nodes, triangles), blocks, device, (number, alpha, point))
            pressing = force @ out
            slipped += 1
            on_cone += abs(np.linalg.norm(force - pressing * out) / pressing / 0.3 - 1) < 0.01
            assert force @ along <= 0 or number != triangle
    assert slipped > 1000
    # The rest has just passed the border of a facet.
    assert on_cone > 0.9 * slipped


@pytest.mark.parametrize(("still", "moving"), [(0.2, 0.3), (-0.1, -0.1), (np.nan, 0.0)])
def test_coefficients_that_make_no_sense_are_refused(cube, still, moving):
    with pytest.raises(ValueError, match="friction"):
        Proxy(cube.native, static_friction=still, dynamic_friction=moving)
