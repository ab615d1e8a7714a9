import numpy as np
import pytest
from bodies.shared import free_triangles, nodal_forces_of

from palpate.core.contact.equations import area_coordinates, one_node_force, two_node_forces
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import press_points, touch_at, touch_nearest
from palpate.core.contact.touches import contact_displacement
from palpate.core.errors import PalpateError

PRESS = np.array([0.001, -0.0005, -0.004])


def test_a_press_on_a_node_gives_equation_9(body):
    triangle = free_triangles(body)[7]
    for corner in range(3):
        touch = touch_at(body, triangle, np.eye(3)[corner], PRESS)
        node = np.searchsorted(body.compliance.free_surface, touch.triangle[corner])
        expected = one_node_force(body.compliance.block(node, node) / body.young_modulus, PRESS)
        np.testing.assert_allclose(touch.nodal_forces[corner], expected, rtol=1e-9)
        np.testing.assert_allclose(touch.force, -expected, rtol=1e-9)
        assert not np.any(np.delete(touch.nodal_forces, corner, axis=0))


@pytest.mark.parametrize("mode", ["consistent", "paper"])
def test_a_press_anywhere_is_what_the_equations_say(body, rng, mode):
    for triangle in rng.choice(free_triangles(body), 50):
        alpha, by = rng.dirichlet([1, 1, 1]), 2e-3 * rng.normal(size=3)
        touch = touch_at(body, triangle, alpha, by, ContactSettings(mode=mode))
        expected = nodal_forces_of(body, triangle, alpha, by, mode)
        scale = np.abs(expected).max()
        np.testing.assert_allclose(touch.nodal_forces, expected, atol=1e-9 * scale)
        np.testing.assert_allclose(touch.force, -expected.sum(axis=0), atol=1e-9 * scale)


def test_deformation_equals_a_sparse_solve_with_the_same_forces(body, rng, solved_displacements):
    for triangle in rng.choice(len(body.mesh.surface_triangles), 5):
        touch = touch_at(body, triangle, rng.dirichlet([1, 1, 1]), PRESS)
        forces = np.zeros_like(body.mesh.nodes)
        forces[touch.triangle] = touch.nodal_forces
        expected = solved_displacements(body, forces)[body.compliance.free_surface]
        ours = body.deform(touch.triangle, touch.nodal_forces)
        assert np.abs(ours - expected).max() < 1e-5 * np.abs(expected).max()


def test_two_nodes_held_at_once_move_by_exactly_both_displacements(body):
    compliance, i, j = body.compliance, 3, 40
    blocks = np.array([[compliance.block(a, b) for b in (i, j)] for a in (i, j)])
    u_i, u_j = PRESS, -2 * PRESS
    forces = np.array(two_node_forces(blocks, u_i, u_j))
    moved = compliance.apply(forces, np.array([i, j]))
    np.testing.assert_allclose(moved[[i, j]], [u_i, u_j], rtol=1e-6)


@pytest.mark.parametrize("mode", ["consistent", pytest.param("paper", marks=pytest.mark.at_length)])
def test_force_is_continuous_across_edges(body, rng, mode):
    triangles = body.mesh.surface_triangles
    owner = {}
    for number, corners in enumerate(triangles):
        for a in range(3):
            owner[int(corners[a]), int(corners[(a + 1) % 3])] = number
    for a, b in list(owner)[:: max(1, len(owner) // 200)]:
        share = rng.random()
        forces = []
        for number in (owner[a, b], owner[b, a]):
            alpha = np.zeros(3)
            alpha[triangles[number] == a] = share
            alpha[triangles[number] == b] = 1 - share
            forces.append(touch_at(body, number, alpha, PRESS, ContactSettings(mode=mode)).force)
        np.testing.assert_allclose(forces[0], forces[1], rtol=1e-12)


def test_force_is_linear_in_depth_and_modulus(body):
    triangle, alpha = free_triangles(body)[5], [0.2, 0.3, 0.5]
    once = touch_at(body, triangle, alpha, PRESS, ContactSettings(100.0)).force
    np.testing.assert_allclose(
        touch_at(body, triangle, alpha, 3 * PRESS, ContactSettings(100.0)).force, 3 * once
    )
    np.testing.assert_allclose(
        touch_at(body, triangle, alpha, PRESS, ContactSettings(700.0)).force, 7 * once
    )


def test_the_felt_force_resists_every_displacement(body, rng):
    for triangle in rng.choice(len(body.mesh.surface_triangles), 50):
        u = rng.normal(size=3) * 0.001
        assert touch_at(body, triangle, rng.dirichlet([1, 1, 1]), u).force @ u < 0


def test_touching_is_reciprocal(body, rng):
    """Maxwell and Betti: i moves under a force at j as j does under the same force at i."""
    n = body.compliance.node_count
    for i, j in rng.integers(0, n, (20, 2)):
        f, g = rng.normal(size=(2, 3))
        under_f = body.compliance.apply(f[None], np.array([i]))[j]
        under_g = body.compliance.apply(g[None], np.array([j]))[i]
        size = np.linalg.norm(body.compliance.block(i, j)) * np.linalg.norm(f) * np.linalg.norm(g)
        assert under_f @ g == pytest.approx(under_g @ f, abs=1e-6 * size)


def test_a_pinned_corner_feels_firm_and_stays_where_it_is(body):
    pinned = np.isin(body.mesh.surface_triangles, body.fixed)
    triangle = int(np.flatnonzero(pinned.any(axis=1))[0])
    corner = int(np.flatnonzero(pinned[triangle])[0])
    touch = touch_at(body, triangle, np.eye(3)[corner], PRESS)
    assert np.isfinite(touch.force).all()
    stiffest = 1 / np.linalg.eigvalsh(body.compliance.diagonal()).min()
    np.testing.assert_allclose(touch.force, -stiffest * body.young_modulus * PRESS)
    moved = body.deform(touch.triangle, touch.nodal_forces)
    assert not np.any(moved)
    assert not np.any(contact_displacement(body, touch, moved))


def test_area_coordinates_rebuild_the_point(rng):
    corners = rng.normal(size=(3, 3))
    alpha = rng.dirichlet([1, 1, 1])
    np.testing.assert_allclose(area_coordinates(alpha @ corners, corners), alpha, atol=1e-12)


def test_touch_nearest_takes_the_closest_surface_point(cube):
    touch = touch_nearest(cube, [0.02, 0.03, 0.08], [0, 0, -0.005])
    np.testing.assert_allclose(touch.point, [0.02, 0.03, 0.05], atol=1e-12)
    assert touch.force[2] > 0


@pytest.mark.parametrize("at", [[0, 0], [0, 0, np.nan], [np.inf, 0, 0]])
def test_a_place_that_is_no_point_is_refused(cube, at):
    with pytest.raises(PalpateError, match="--at"):
        touch_nearest(cube, at, [0, 0, 0])


@pytest.mark.parametrize("modulus", [0.0, -1.0, np.nan, np.inf])
def test_a_modulus_that_is_none_is_refused(cube, modulus):
    at, by = [0.02, 0.03, 0.08], [0, 0, -0.005]
    with pytest.raises(PalpateError, match=f"modulus is {modulus} Pa"):
        touch_nearest(cube, at, by, ContactSettings(modulus))
    with pytest.raises(PalpateError, match=f"modulus is {modulus} Pa"):
        press_points(cube, [at], [by], ContactSettings(modulus))
    with pytest.raises(PalpateError, match=f"modulus is {modulus} Pa"):
        cube.deform([0], [[0, 0, 1.0]], modulus)
    assert cube.modulus(None) == cube.young_modulus


@pytest.mark.parametrize(
    ("triangle", "alpha", "said"),
    [
        (0, [5.0, 5.0, 5.0], "add up to 1"),
        (0, [2.0, -0.5, -0.5], "not negative"),
        (0, [0.0, 0.0, 0.0], "add up to 1"),
        (-1, [1.0, 0.0, 0.0], "triangle -1, and the body has 0 to"),
        (10**9, [1.0, 0.0, 0.0], "triangle 1000000000, and the body has 0 to"),
    ],
)
def test_a_place_that_is_none_is_refused(body, triangle, alpha, said):
    with pytest.raises(PalpateError, match=said):
        touch_at(body, triangle, alpha, PRESS)
