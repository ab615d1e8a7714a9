"""Shapes of loads that change while they are looked for."""

import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.soft_block import block_mesh

from palpate.core.shape.felt import held_loads
from palpate.core.shape.found_behind import FoundBehind
from palpate.core.shape.rotation_strain.finger_load import FingerLoad
from palpate.core.shape.rotation_strain.rotation_strain_shape import (
    FramePlan,
    RotationStrainShape,
)
from palpate.core.shape.shapes import pressed_by, shape

MODULUS = 5_000.0


@pytest.fixture(scope="module")
def bar():
    mesh = block_mesh((0.1, 0.03, 0.03), (10, 3, 3))
    return baked_body(mesh, np.flatnonzero(mesh.nodes[:, 0] == 0.0), 0.3, MODULUS)


@pytest.fixture
def behind(bar):
    made = shape(bar, "real")
    found = FoundBehind(bar, made, MODULUS)
    yield found
    found.close()
    made.close()


def bent(bar, share=1.0):
    """Held at the free end, where a linear body bends by ``share`` of 3 cm."""
    end = np.flatnonzero(bar.mesh.nodes[:, 0] > 0.099)
    forces = np.tile([0.0, 0.0, 1.0 / len(end)], (len(end), 1))
    moved = bar.deform(end, forces, MODULUS)[bar.free_index(end), 2].mean()
    return held_loads(bar, end, share * 0.03 / moved * forces)


def test_at_rest_it_is_the_shape_and_the_force_of_the_press(bar, behind):
    loads = bent(bar)
    found = behind.at_rest(loads)
    true = pressed_by(behind.shape, loads, MODULUS).displacements
    np.testing.assert_allclose(found.displacements, true, atol=1e-12)
    assert found.share == pressed_by(behind.shape, loads, MODULUS).firmness.deepest
    assert abs(found.share - 1.0) > 0.02


def test_what_is_held_is_where_a_linear_body_has_it(bar, behind):
    loads = bent(bar)
    held = bar.free_index(np.concatenate([one.nodes for one in loads]))
    linear = bar.deform(*joined(loads), MODULUS)
    found = behind.at_rest(loads).displacements
    off = np.abs(found - linear).max(axis=1)
    assert off[held].max() < 0.01 * np.abs(linear).max() < off.max() * 0.5


def test_until_it_is_known_it_is_linear_and_then_follows(bar, behind, eventually):
    loads = bent(bar)
    linear = bar.deform(*joined(loads), MODULUS)
    first = behind.now(loads)
    np.testing.assert_array_equal(first.displacements, linear)
    assert first.share == 1.0
    eventually(lambda: behind.news, "the end of the search")
    whole = behind.now(loads)
    np.testing.assert_allclose(whole.displacements, behind.at_rest(loads).displacements, atol=1e-9)
    less = behind.now(bent(bar, 0.9))
    added = less.displacements - 0.9 * linear
    np.testing.assert_allclose(added, 0.81 * (whole.displacements - linear), atol=1e-7)
    assert abs(less.share - 1.0) < abs(whole.share - 1.0)


def test_no_force_moves_nothing_and_nothing_is_looked_for(bar, behind):
    nothing = [FingerLoad(np.array([5]), np.zeros((1, 3)), sticks=True)]
    for loads in ([], nothing):
        for found in (behind.now(loads), behind.at_rest(loads)):
            assert not found.displacements.any()
            assert found.share == 1.0
    assert not behind.news


def test_a_body_that_is_drawn_on_a_lattice_is_felt_on_its_own_nodes(bar, behind):
    loads, large = bent(bar), RotationStrainShape(bar, FramePlan(2, 60))
    for made in (large, behind.shape):
        made.wait_for(loads[0].nodes)
    own, its = (pressed_by(one, loads, MODULUS) for one in (behind.shape, large))
    assert its.firmness == own.firmness
    np.testing.assert_array_equal(its.displacements, own.displacements)
    large.close()


def joined(loads):
    return np.concatenate([one.nodes for one in loads]), np.concatenate(
        [one.forces for one in loads]
    )
