"""Bodies go on from where they rested, and follow what moves through a time."""

from __future__ import annotations

import numpy as np
import pytest

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate
from palpate.core.rest.following import Ways, between, follow
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor, Support

HALF_TURN = np.diag([1.0, -1.0, -1.0])


def table(height, friction=0.5):
    """A plate whose face looks up."""
    return Support(plate(0.2, 0.2), Pose(np.array([0.025, 0.025, height]), HALF_TURN), friction)


def test_a_body_goes_on_from_where_it_rested_on_a_table(cube):
    settings = RestSettings(friction=0.0)
    first = Resting(
        cube,
        [table(0.0, 0.0)],
        placement=Pose(np.array([0.0, 0.0, 0.002]), np.eye(3)),
        settings=settings,
    ).settle()
    again = Resting(cube, [table(0.0, 0.0)], placement=first.placement, settings=settings)
    again.come_in()
    here = again.rest
    np.testing.assert_array_equal(here.placement.position, first.placement.position)
    np.testing.assert_allclose(
        here.supports[0].force, first.supports[0].force, atol=1e-6 * cube.mass * 9.81
    )
    np.testing.assert_allclose(
        again.settle().placement.position, first.placement.position, atol=1e-9
    )


def test_a_table_that_is_raised_takes_the_body_along(cube):
    resting = Resting(cube, [table(0.0)], placement=Pose(np.array([0.0, 0.0, 0.002]), np.eye(3)))
    before = resting.settle()
    low, high = table(0.0).pose, table(0.01).pose
    follow(resting, Ways([], [(table(0.0).tool, low, high)]), 0.2)
    follow(resting, Ways([], [(table(0.0).tool, high, high)]), 0.2)
    raised = resting.rest.placement.position[2] - before.placement.position[2]
    assert raised == pytest.approx(0.01, rel=0.02)


def test_what_falls_goes_by_gravity_times_the_drag_time(cube):
    resting = Resting(cube, [Floor(-1.0)])
    follow(resting, Ways([], [(None, Floor(-1.0).pose, Floor(-1.0).pose)]), 0.1)
    assert resting.rest.placement.position[2] == pytest.approx(-9.81 * 0.05 * 0.1, rel=1e-6)


def test_between_two_poses_lies_half_of_way_and_turn():
    end = Pose(
        np.array([2.0, 0.0, 0.0]), np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    )
    half = between(Pose(np.zeros(3), np.eye(3)), end, 0.5)
    np.testing.assert_allclose(half.position, (1.0, 0.0, 0.0))
    np.testing.assert_allclose(half.rotation @ half.rotation, end.rotation, atol=1e-12)
