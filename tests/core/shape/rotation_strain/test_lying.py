"""A body that nothing holds: at rest under forces that balance, and where it is as a whole."""

import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.bare_body import bare_body, beam_mesh

from palpate.core.shape.rotation_strain.lying import met
from palpate.core.shape.rotation_strain.relaxation import relaxation
from palpate.core.shape.rotation_strain.rotation_strain_shape import FramePlan, RotationStrainShape
from palpate.core.shape.solid.free_solid import FreeSolid

LENGTH = 5.0


def free_beam(cells=4):
    mesh, _ = beam_mesh(cells, LENGTH, 0)
    return bare_body(mesh, np.zeros(0, dtype=np.int64), 0.3, "smoothed")


@pytest.fixture(scope="module")
def beam():
    return FreeSolid.of(free_beam())


def bending(solid, share):
    """Forces (f, 3), up on both ends and down in the middle, under which it bends so far."""
    x = solid.positions[:, 0]
    ends = (x == 0.0) | (x == LENGTH)
    middle = np.isclose(x, LENGTH / 2)
    up = np.where(ends, 1.0 / ends.sum(), np.where(middle, -1.0 / middle.sum(), 0.0))
    forces = up[:, None] * [0.0, 0.0, 1.0]
    return forces * share * LENGTH / np.abs(solid.linear(forces)).max()


def test_linear_displacements_are_those_of_its_compliance(beam):
    forces = np.random.default_rng(5).normal(size=(beam.node_count, 3))
    balanced = beam.motions.balanced(forces)
    moved = beam.linear(forces)
    np.testing.assert_allclose(beam.motions.loads.T @ moved.ravel(), 0.0, atol=1e-9)
    np.testing.assert_allclose(beam.motions.modes.T @ balanced.ravel(), 0.0, atol=1e-9)
    held = beam.solid.tangent(np.zeros_like(moved)) @ moved.ravel()
    np.testing.assert_allclose(held, balanced.ravel(), atol=1e-8 * np.abs(forces).max())


def test_many_steps_arrive_where_inertia_alone_is_left(beam):
    forces = bending(beam, 0.15)
    moved = relaxation(beam).relaxed(forces, 20)
    assert np.abs(moved - beam.linear(forces)).max() > 0.02 * np.abs(moved).max()
    left = beam.motions.balanced(beam.forces(moved) - forces)
    assert np.abs(left).max() < 1e-6 * np.abs(forces).max()
    np.testing.assert_allclose(beam.motions.loads.T @ moved.ravel(), 0.0, atol=1e-9)


def test_both_halves_bend_alike(beam):
    moved = relaxation(beam).relaxed(bending(beam, 0.15), 20)
    sag = {}
    for end in (0.0, LENGTH):
        sag[end] = moved[beam.positions[:, 0] == end, 2].mean()
    assert sag[0.0] == pytest.approx(sag[LENGTH], rel=0.02)
    # An end comes nearer to the middle as the bar bends.
    inward = [moved[beam.positions[:, 0] == end, 0].mean() for end in (0.0, LENGTH)]
    assert inward[0] > 0.0 > inward[1]


def test_a_change_of_forces_on_what_is_drawn_does_as_much_on_what_is_linear(beam):
    random = np.random.default_rng(3)
    native = relaxation(beam).native
    linear = beam.motions.still(0.1 * random.normal(size=(beam.node_count, 3)))
    forces = random.normal(size=(beam.node_count, 3))
    change = beam.motions.still(random.normal(size=(beam.node_count, 3)))
    step = 1e-6
    ahead, behind = (native.warped(linear + sign * step * change) for sign in (1.0, -1.0))
    work = float((forces * (ahead - behind)).sum()) / (2.0 * step)
    pulled = native.pulled_back(linear, forces)
    assert float((pulled * change).sum()) == pytest.approx(work, rel=1e-6)


def test_what_is_pressed_is_where_a_linear_body_has_it(beam):
    forces, motion = bending(beam, 0.1), np.array([0.1, 0.2, -0.3, 0.0, 0.2, 0.0])
    linear = beam.linear(forces)
    away = linear + beam.motions.of_nodes @ motion
    back = met(beam.motions.of_nodes, away, linear, forces)
    pressed = forces.any(axis=1)
    np.testing.assert_allclose(back[pressed, 2], linear[pressed, 2], atol=1e-4)
    # Along what no force feels it stays where it was.
    np.testing.assert_allclose((back - away)[pressed, 0].mean(), 0.0, atol=1e-3)


def test_on_a_lattice_it_is_drawn_as_on_its_own_nodes():
    mesh, _ = beam_mesh(6, LENGTH, 0)
    body = baked_body(mesh, np.zeros(0, dtype=np.int64), 0.3, 1.0, "smoothed")
    solid = FreeSolid.of(body)
    forces = bending(solid, 0.15)
    inside = np.setdiff1d(np.arange(solid.node_count), solid.surface)
    forces[inside] = 0.0
    truth = relaxation(solid).relaxed(forces, 20)[solid.surface]
    coarse = RotationStrainShape(body, FramePlan(3, 200))
    coarse.wait_for(body.mesh.surface_nodes[:1])
    drawn = coarse.displacements(solid.free[solid.surface], forces[solid.surface], 1.0)
    coarse.close()
    linear = solid.linear(forces)[solid.surface]

    def off(moved):
        # Where it is as a whole is told by what presses it.
        still = [one - one.mean(axis=0) for one in (moved, truth)]
        return np.linalg.norm(still[0] - still[1]) / np.linalg.norm(still[1])

    assert off(drawn) < 0.5 * off(linear)


def test_what_a_hand_steadies_is_moved_in_its_only_direction_or_not_at_all(beam):
    forces, motion = bending(beam, 0.1), np.array([0.1, 0.2, -0.3, 0.0, 0.2, 0.0])
    linear, modes = beam.linear(forces), beam.motions.of_nodes
    away = linear + modes @ motion
    np.testing.assert_array_equal(met(modes, away, linear, forces, np.zeros(3)), away)
    up = np.array([0.0, 0.0, 1.0])
    moved = met(modes, away, linear, forces, up) - away
    # All alike, until what is pressed, all of it along z, is where it is linearly in the mean.
    np.testing.assert_allclose(moved, moved[:1].repeat(len(moved), axis=0), atol=1e-15)
    np.testing.assert_allclose(moved[0, :2], 0.0, atol=1e-15)
    sizes = np.linalg.norm(forces, axis=1)
    missed = sizes @ (linear - away - moved)[:, 2]
    assert abs(missed) < 1e-4 * sizes @ np.abs(linear - away)[:, 2]
