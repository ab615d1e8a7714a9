"""Cubes one on the other: what each carries, how far all sink, and what is lost on the way."""

import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.free_shapes import free_block
from bodies.soft_block import block_mesh

from palpate.core.contact.tool.pose import Pose
from palpate.core.errors import PalpateError
from palpate.core.pile.pile import Pile
from palpate.core.pile.pile_settings import PileSettings
from palpate.core.rest.support import Floor

EDGE, GRAVITY = 0.05, 9.81


def stacked(cube, count, friction=0.5, apart=2e-5):
    bodies = [(cube, Pose.at([0.0, 0.0, (EDGE + apart) * k])) for k in range(count)]
    settings = PileSettings(friction=friction)
    return Pile(bodies, [Floor(friction=friction)], settings=settings)


@pytest.mark.parametrize("count", [2, pytest.param(4, marks=pytest.mark.at_length)])
def test_each_carries_all_above(cube, count):
    rests = stacked(cube, count).settle()
    weight = cube.mass * GRAVITY
    floor = rests[0].supports[0].force
    np.testing.assert_allclose(floor, [0.0, 0.0, -count * weight], atol=1e-6 * weight)
    for lower in range(count - 1):
        above = (count - 1 - lower) * weight
        on_upper = rests[lower].others[lower + 1].force
        np.testing.assert_allclose(on_upper, [0.0, 0.0, above], atol=1e-6 * weight)


def test_a_force_and_its_opposite_are_one(cube):
    rests = stacked(cube, 2).settle()
    there, back = rests[0].others[1], rests[1].others[0]
    np.testing.assert_array_equal(there.force, -back.force)
    np.testing.assert_array_equal(there.places, back.places)
    for rest, touch in ((rests[0], there), (rests[1], back)):
        in_world = touch.nodal_forces.sum(axis=0) @ rest.placement.rotation.T
        np.testing.assert_allclose(in_world, -touch.force, atol=1e-12)


def test_a_column_sinks_under_its_weight():
    """Linear theory of two cubes whose ends may widen: the top sinks by (rho g / E) (2 h)^2 / 2."""
    cube = free_block((EDGE,) * 3, (8, 8, 8), young_modulus=100_000.0)
    pile = stacked(cube, 2, friction=0.0, apart=0.0)
    for _ in range(120):
        _, upper = pile.step(2e-3)
    top = upper.surface()[:, 2].max()
    sunk = 2.0 * EDGE - top
    assert sunk == pytest.approx(0.5 * 1000.0 * GRAVITY * (2.0 * EDGE) ** 2 / 100_000.0, rel=0.02)


def test_nothing_is_gained_on_the_way(cube):
    pile = stacked(cube, 3, apart=2e-3)
    scale = cube.mass * GRAVITY * EDGE
    before = np.inf
    for _ in range(200):
        rests = pile.step(1e-3)
        heights = sum(float(rest.centre[2]) for rest in rests)
        now = sum(rest.elastic for rest in rests) + cube.mass * GRAVITY * heights
        assert now <= before + 1e-5 * scale
        before = now


def test_bodies_that_nothing_else_touches_keep_their_common_centre():
    """Two that overlap and part without weight: no force from outside, no torque."""
    block = free_block((0.04, 0.03, 0.02), (4, 3, 2))
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    bodies = [(block, Pose.at([0.0, 0.0, 0.0])), (block, Pose.at([0.03, 0.0, 0.0195], turn))]
    pile = Pile(bodies, settings=PileSettings(gravity=(0.0, 0.0, 0.0)))
    before = sum(rest.centre for rest in pile.rests)
    for _ in range(20):
        rests = pile.step(1e-4)
        assert (
            np.abs(torque_of_all(rests)).max()
            < 0.01 * EDGE * np.abs(rests[0].others[1].force).max()
        )
    np.testing.assert_allclose(sum(rest.centre for rest in rests), before, atol=1e-12)
    assert rests[1].centre[2] - rests[0].centre[2] > 0.0195


def torque_of_all(rests):
    """Of all forces on nodes, where these are now, about the world's origin, (3,), N m."""
    torque = np.zeros(3)
    for rest in rests:
        numbers = np.full(len(rest.body.mesh.nodes), -1)
        numbers[rest.body.compliance.free_surface] = np.arange(len(rest.surface()))
        for touch in rest.others:
            places = rest.surface()[numbers[touch.nodes]]
            forces = touch.nodal_forces @ rest.placement.rotation.T
            torque += np.cross(places, forces).sum(axis=0)
    return torque


def test_a_pinned_body_bears_a_free_one(cube):
    mesh = block_mesh((0.08, 0.08, 0.03), (8, 8, 3))
    foot = np.flatnonzero(mesh.nodes[:, 2] == 0.0)
    pinned = baked_body(mesh, foot, 0.3, 100_000.0)
    above = Pose.at([0.015, 0.015, 0.0301])
    _, upper = Pile([(pinned, Pose.at([0.0, 0.0, 0.0])), (cube, above)]).settle()
    weight = cube.mass * GRAVITY
    np.testing.assert_allclose(upper.others[0].force, [0.0, 0.0, -weight], atol=1e-6 * weight)


def test_what_cannot_be_is_refused(cube):
    with pytest.raises(PalpateError, match="from 1 to 16"):
        Pile([])
    with pytest.raises(PalpateError, match="still moves"):
        Pile([(cube, Pose.at([0.0, 0.0, 0.0]))]).settle()
