"""The corrected relation: convex, the linear one at first, and nearer to the solid when deep."""

import numpy as np
import pytest
from bodies.baked_body import baked_body
from referees.pressed_point import pressed_point
from referees.softened_points import Relation

from palpate.core.contact.near_field.surface_shape import node_normals
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import touch_at
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.force_at_depth.felt_force import LEAST_SHARE, felt_name
from palpate.core.shape.force_at_depth.softening import node_softening
from palpate.core.shape.solid.free_solid import FreeSolid

EDGE = 0.05


def cube(formulation="linear"):
    return baked_body(*paper_cube(EDGE), formulation=formulation, dtype=np.float64)


def softenings_of(body, solid):
    found = np.zeros((len(body.mesh.surface_nodes), 4))
    free = np.searchsorted(body.mesh.surface_nodes, body.compliance.free_surface)
    found[free] = node_softening(solid, solid.surface, -node_normals(body.mesh)[free])
    return found


@pytest.fixture(scope="module")
def body():
    return cube()


@pytest.fixture(scope="module")
def solid(body):
    return FreeSolid.of(body)


@pytest.fixture(scope="module")
def softenings(body, solid):
    return softenings_of(body, solid)


def newton_forces(solid, nodes, alpha, displacements):
    """Forces (k, 3) at unit modulus that move the mean of nodes by displacements (k, 3) in turn."""
    forces = pressed_point(solid, nodes, np.array(alpha), displacements).forces
    assert len(forces) == len(displacements)
    return forces


def felt(body, softenings, triangle, alpha, displacements):
    """Forces (k, 3) on the body at unit modulus under displacements (k, 3)."""
    unit = ContactSettings(1.0)
    touches = [
        touch_at(body, triangle, alpha, u, unit, softenings=softenings) for u in displacements
    ]
    return -np.array([touch.force for touch in touches])


def relations(count=200):
    """Relations of all kinds with displacements from shallow to absurd, on both sides of t = 0."""
    chance = np.random.default_rng(3)
    for number in range(count):
        root = chance.standard_normal((3, 3))
        stiffness = 100.0 * (root @ root.T + 0.1 * np.eye(3))
        softening = 50.0 * chance.standard_normal(3)
        saturation = 10.0 ** chance.uniform(1, 4)
        u = chance.standard_normal(3) * 10.0 ** chance.uniform(-4, -0.5)
        yield Relation(stiffness, softening, saturation if number % 4 else 1e4), u


def test_the_force_is_the_gradient_of_the_energy():
    for relation, u in relations():
        step = 1e-6 * np.linalg.norm(u)
        slopes = [
            (relation.energy(u + step * axis) - relation.energy(u - step * axis)) / (2 * step)
            for axis in np.eye(3)
        ]
        force = relation.force(u)
        assert np.allclose(slopes, force, rtol=0, atol=1e-7 * np.abs(relation.stiffness @ u).max())


def test_the_tangent_is_the_derivative_of_the_force():
    for relation, u in relations():
        step = 1e-5 * np.linalg.norm(u)
        columns = [
            (relation.force(u + step * axis) - relation.force(u - step * axis)) / (2 * step)
            for axis in np.eye(3)
        ]
        tangent = relation.tangent(u)
        assert np.allclose(np.array(columns).T, tangent, rtol=0, atol=1e-6 * np.abs(tangent).max())
        assert np.allclose(tangent, tangent.T, rtol=0, atol=1e-13 * np.abs(tangent).max())


def test_the_energy_is_convex_wherever_it_is_looked_at():
    for relation, u in relations():
        rest = relation.tangent(u) - LEAST_SHARE * relation.stiffness
        assert np.linalg.eigvalsh(rest)[0] > -1e-12 * np.abs(relation.stiffness).max()


def test_a_shallow_press_feels_the_linear_force(body, softenings):
    for depth in (1e-6, 1e-7):
        touch = (120, [0.2, 0.3, 0.5], [0.0, 0.3 * depth, -depth])
        linear, found = (touch_at(body, *touch, softenings=table) for table in (None, softenings))
        gone = np.linalg.norm(found.force - linear.force) / np.linalg.norm(linear.force)
        assert 0 < gone < 100 * depth


@pytest.mark.parametrize("mode", ["consistent", "paper"])
def test_the_force_is_the_same_from_both_sides_of_an_edge(body, softenings, mode):
    triangles = body.mesh.surface_triangles
    first = next(t for t, corners in enumerate(triangles) if not np.isin(corners, body.fixed).any())
    shared = triangles[first][:2]
    other = next(
        t for t, corners in enumerate(triangles) if t != first and np.isin(shared, corners).all()
    )
    u, settings = np.array([0.002, -0.003, -0.006]), ContactSettings(mode=mode)
    forces = []
    for triangle in (first, other):
        alpha = np.where(triangles[triangle] == shared[0], 0.3, 0.0)
        alpha[triangles[triangle] == shared[1]] = 0.7
        forces.append(touch_at(body, triangle, alpha, u, settings, softenings=softenings).force)
    assert np.allclose(*forces, rtol=1e-12)
    linear = touch_at(body, first, [0.3, 0.7, 0.0], u, settings).force
    assert np.linalg.norm(forces[0] - linear) > 0.05 * np.linalg.norm(linear)


@pytest.mark.parametrize("formulation", ["linear", "smoothed"])
def test_at_a_node_it_follows_the_solid_to_its_order(formulation):
    body = cube(formulation)
    solid = FreeSolid.of(body)
    softenings = softenings_of(body, solid)
    # Beside the middle of the cube's top: the force turns as the depth grows.
    node = int(np.argmin(np.linalg.norm(body.mesh.nodes - [0.0125, 0.025, EDGE], axis=1)))
    triangle, corner = np.argwhere(body.mesh.surface_triangles == node)[0]
    alpha = np.eye(3)[corner]
    inward = -node_normals(body.mesh)[np.searchsorted(body.mesh.surface_nodes, node)]
    depths = np.array([0.00025, 0.0005])
    true = newton_forces(solid, [node], [1.0], depths[:, None] * inward)
    missed = felt(body, softenings, int(triangle), alpha, depths[:, None] * inward) - true
    along = np.abs(missed @ inward) / (true @ inward)
    across = np.linalg.norm(missed, axis=1) / np.linalg.norm(true, axis=1)
    assert along[1] < 5e-4
    # Of third order where the saturation is free, of second where it is at its least.
    assert along[1] / along[0] > 3.5
    assert across[1] / across[0] > 3.5


def test_deep_presses_are_nearer_to_the_solid_than_the_linear_force(body, solid, softenings):
    middle = int(np.argmin(np.linalg.norm(body.mesh.nodes - [0.025, 0.025, EDGE], axis=1)))
    edge = int(np.argmin(np.linalg.norm(body.mesh.nodes - [0.025, 0.0, EDGE], axis=1)))
    top = [
        t
        for t, corners in enumerate(body.mesh.surface_triangles)
        if middle in corners and (body.mesh.nodes[corners][:, 2] == EDGE).all()
    ]
    down = np.array([0.0, 0.0, -1.0])
    # Each with the share of the linear error that is left at most. Aslant within a triangle, what
    # the nodes tell is no better than the linear relation.
    presses = [
        (top[0], np.where(body.mesh.surface_triangles[top[0]] == middle, 1.0, 0.0), down, 0.2),
        (top[0], np.array([1, 1, 1]) / 3, down, 0.7),
        (top[1], np.array([0.6, 0.3, 0.1]), np.array([0.5, 0.0, -(0.75**0.5)]), 1.4),
    ]
    on_edge, corner = np.argwhere(body.mesh.surface_triangles == edge)[0]
    presses.append((int(on_edge), np.eye(3)[corner], np.array([0.0, 1.0, -1.0]) / 2**0.5, 0.05))
    depths = EDGE * np.array([0.02, 0.06, 0.1, 0.14])
    for triangle, alpha, direction, left in presses:
        asked = depths[:, None] * direction
        true = newton_forces(solid, body.mesh.surface_triangles[triangle], alpha, asked)
        wrong = felt(body, softenings, triangle, alpha, asked) - true
        linear = felt(body, None, triangle, alpha, asked) - true
        share = np.linalg.norm(wrong, axis=1) / np.linalg.norm(linear, axis=1)
        assert share.max() < left


def test_an_unknown_name_is_refused():
    assert felt_name("corrected") == "corrected"
    with pytest.raises(PalpateError, match="'true' is unknown; give linear or corrected"):
        felt_name("true")
