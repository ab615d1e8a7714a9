"""Contacts whose points move by exactly the fingers' displacements, against a direct solve."""

import numpy as np
import pytest
import skfem
from bodies.baked_body import baked_body
from bodies.shared import free_triangles
from scipy.sparse import bmat, coo_array
from scipy.sparse.linalg import spsolve
from skfem.models.elasticity import lame_parameters as referee_lame
from skfem.models.elasticity import linear_elasticity

from palpate.core.contact.equations import consistent_forces, contact_compliance
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import press_points, touch_at, touch_nearest
from palpate.core.contact.touches import contact_displacement
from palpate.core.errors import PalpateError
from palpate.core.mesh.tet_mesh import TetMesh

PRESS = np.array([0.001, -0.0005, -0.004])


def held_by_lagrange(body, triangles, alphas, displacements):
    """Forces (m, 3) of a whole FEM solve in which the contact points are moved as asked.

    Stiffness by scikit-fem; the contact points as multi-point constraints by Lagrange multipliers,
    which are the forces.
    """
    mesh = body.mesh
    tets = skfem.MeshTet(mesh.nodes.T.copy(), mesh.tets.T.copy(), sort_t=False)
    basis = skfem.Basis(tets, skfem.ElementVector(skfem.ElementTetP1()), intorder=1)
    lame = referee_lame(body.young_modulus, body.poisson_ratio)
    order = basis.nodal_dofs.T.ravel()
    K = linear_elasticity(*lame).assemble(basis).tocsr()[order][:, order]
    rows, columns, weights = [], [], []
    for contact, (triangle, alpha) in enumerate(zip(triangles, alphas, strict=True)):
        for node, weight in zip(mesh.surface_triangles[triangle], alpha, strict=True):
            for axis in range(3):
                rows.append(3 * contact + axis)
                columns.append(3 * node + axis)
                weights.append(weight)
    shape = (3 * len(triangles), K.shape[0])
    A = coo_array((weights, (rows, columns)), shape=shape).tocsr()
    held = (3 * body.fixed[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(K.shape[0]), held)
    saddle = bmat([[K[free][:, free], A[:, free].T], [A[:, free], None]], format="csc")
    load = np.concatenate([np.zeros(len(free)), np.ravel(displacements)])
    return -spsolve(saddle, load)[len(free) :].reshape(-1, 3)


def test_one_contact_is_what_a_constrained_solve_of_the_whole_body_gives(body, rng):
    for triangle in rng.choice(free_triangles(body), 2):
        alpha = rng.dirichlet([1, 1, 1])
        force = held_by_lagrange(body, [triangle], [alpha], PRESS)[0]
        touch = touch_at(body, triangle, alpha, PRESS)
        atol = 1e-4 * np.abs(force).max()
        np.testing.assert_allclose(-touch.force, force, rtol=0, atol=atol)
        np.testing.assert_allclose(touch.nodal_forces, alpha[:, None] * force, rtol=0, atol=atol)


def test_two_contacts_are_what_a_constrained_solve_of_the_whole_body_gives(body):
    low, high = body.mesh.nodes.min(axis=0), body.mesh.nodes.max(axis=0)
    middle = 0.5 * (low + high)
    at = np.array([[low[0], *middle[1:]], [high[0], *middle[1:]]])  # a pinch
    by = 0.05 * (high[0] - low[0]) * np.array([[1, 0.1, 0], [-0.8, 0, 0.1]])
    touches = press_points(body, at, by)
    places = body.closest_points.query(at)
    forces = held_by_lagrange(body, places.triangle, places.alpha, by)
    ours = np.array([-touch.force for touch in touches])
    np.testing.assert_allclose(ours, forces, rtol=0, atol=1e-4 * np.abs(forces).max())
    alone = np.array([-touch_nearest(body, *one).force for one in zip(at, by, strict=True)])
    assert np.abs(alone - forces).max() > 0.02 * np.abs(forces).max()  # They do feel each other.


def test_the_contact_point_moves_by_exactly_the_finger_everywhere(body, rng):
    for triangle in rng.choice(free_triangles(body), 30):
        touch = touch_at(body, triangle, rng.dirichlet([1, 1, 1]), PRESS)
        moved = body.deform(touch.triangle, touch.nodal_forces)
        np.testing.assert_allclose(contact_displacement(body, touch, moved), PRESS, rtol=1e-4)


def test_in_paper_mode_it_does_not(body):
    touch = touch_at(
        body, free_triangles(body)[3], [1 / 3, 1 / 3, 1 / 3], PRESS, ContactSettings(mode="paper")
    )
    moved = contact_displacement(body, touch, body.deform(touch.triangle, touch.nodal_forces))
    assert np.linalg.norm(moved - PRESS) > 0.05 * np.linalg.norm(PRESS)


def test_in_paper_mode_it_stays_short_of_the_finger_inside_triangles(body, rng):
    """As docs/contact.md has it: along the finger's way the point never goes farther than it."""
    triangles = free_triangles(body)
    for _ in range(40):
        triangle, alpha, by = rng.choice(triangles), rng.dirichlet([1, 1, 1]), rng.normal(size=3)
        by *= 0.002 / np.linalg.norm(by)
        made = touch_at(body, int(triangle), alpha, by, ContactSettings(mode="paper"))
        displacements = body.deform(made.triangle, made.nodal_forces)
        share = contact_displacement(body, made, displacements) @ by / (by @ by)
        assert 0.2 < share < 1.0 + 1e-9


def test_no_other_forces_on_the_three_nodes_do_it_with_less_energy(body, rng):
    for triangle in rng.choice(free_triangles(body), 10):
        alpha = rng.dirichlet([1, 1, 1])
        local = body.mesh.surface_local_triangles[triangle]
        L = body.surface_blocks(local, local)
        forces = consistent_forces(L, alpha, PRESS)
        weights = np.einsum("a,abij->ibj", alpha, L).reshape(3, 9)
        kept = np.linalg.svd(weights)[2][3:]  # Changes that leave the contact point where it is.
        for change in (rng.normal(size=(20, 6)) @ kept).reshape(-1, 3, 3):
            other = forces + change * np.abs(forces).max()
            before = np.einsum("ai,abij,bj", forces, L, forces)
            np.testing.assert_allclose(
                weights @ other.ravel(), PRESS, atol=1e-10 * np.abs(weights).max()
            )
            assert np.einsum("ai,abij,bj", other, L, other) > before


def test_a_turned_body_answers_with_turned_forces(cube_mesh, rng):
    mesh, fixed = cube_mesh
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    forces = []
    for rotation in (np.eye(3), turn):
        turned = TetMesh.checked(mesh.nodes @ rotation.T + rotation[0], mesh.tets)
        body = baked_body(turned, fixed, 0.4, dtype=np.float64)
        touch = touch_at(body, free_triangles(body)[9], [0.1, 0.6, 0.3], rotation @ PRESS)
        forces.append(touch.force @ rotation)
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-9)


def test_compliance_of_a_contact_is_symmetric_and_positive_also_near_pins(body, rng):
    for triangle in range(0, len(body.mesh.surface_triangles), 7):
        local = body.mesh.surface_local_triangles[triangle]
        C = contact_compliance(body.surface_blocks(local, local), rng.dirichlet([0.3, 0.3, 0.3]))
        np.testing.assert_allclose(C, C.T, rtol=0, atol=1e-12 * C.max())
        assert np.linalg.eigvalsh(C)[0] > 0


def test_pinned_nodes_have_a_block_of_their_own_and_none_with_others(cube):
    nodes = cube.mesh.surface_nodes
    pinned = np.flatnonzero(np.isin(nodes, cube.fixed))[:2]
    free = np.flatnonzero(~np.isin(nodes, cube.fixed))[:2]
    blocks = cube.surface_blocks([*pinned, *free, pinned[0]], [*pinned, *free])
    firmest = np.linalg.eigvalsh(cube.compliance.diagonal()).min()
    for a, b in np.ndindex(2, 2):
        np.testing.assert_allclose(blocks[a, b], firmest * np.eye(3) * (a == b))
        np.testing.assert_array_equal(
            blocks[2 + a, 2 + b], cube.compliance.block(*cube.free_index(nodes[free[[a, b]]]))
        )
    assert not blocks[:2, 2:].any()
    assert not blocks[2:4, :2].any()
    np.testing.assert_array_equal(blocks[4], blocks[0])


def test_forces_on_a_node_that_is_named_twice_are_summed(body, rng):
    nodes = rng.choice(body.mesh.surface_nodes, 50)
    forces = rng.normal(size=(50, 3))
    total = np.zeros((len(body.mesh.nodes), 3))
    np.add.at(total, nodes, forces)
    expected = body.compliance.apply(total[body.compliance.free_surface]) / body.young_modulus
    moved = body.deform(nodes, forces)
    np.testing.assert_allclose(moved, expected, rtol=0, atol=1e-6 * np.abs(expected).max())
    assert not body.deform(np.zeros(0, int), np.zeros((0, 3))).any()


def test_an_unknown_mode_is_refused(cube):
    with pytest.raises(PalpateError, match="'exact' is unknown; give consistent or paper"):
        touch_at(cube, 0, [1, 0, 0], PRESS, ContactSettings(mode="exact"))
