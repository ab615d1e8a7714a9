"""No forces on contact points give energy, on parts of a few elements neither."""

import numpy as np
import pytest

from palpate.core.contact.near_field.compliance_beneath import near_correction
from palpate.core.contact.near_field.point_compliance import point_compliance
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate
from palpate.core.rest.bearing_points import bearing_points, pressing_points
from palpate.core.rest.definite import as_matrix, carried_over
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.tests.referees.rest_trials import shapes

CUBE, BAR, SLAB, _ = range(4)


@pytest.fixture(scope="module")
def bar():
    return shapes()[BAR]


def least_energy(body, points, near):
    """The least principal value of the compliance, as a share of the points' own."""
    everyone = np.arange(len(points))
    compliance = as_matrix(point_compliance(body, points, everyone, everyone, near))
    return np.linalg.eigvalsh(compliance)[0] / np.median(np.diag(compliance))


def test_a_bar_as_thick_as_two_elements_gives_no_energy(bar):
    points, near = bearing_points(bar)
    assert least_energy(bar, points, near_correction(bar, points)) < -0.4
    assert least_energy(bar, points, near) > 0.02
    # No pair by more than its part of a smooth mode.
    everyone = np.arange(len(points))
    changed = near.between(everyone, everyone)
    changed -= near_correction(bar, points).between(everyone, everyone)
    assert np.abs(changed).max() < 0.02 * np.median(np.einsum("pxx->px", near.own))


def test_what_is_definite_stays_as_it_is():
    cube = shapes()[CUBE]
    points, near = bearing_points(cube)
    everyone = np.arange(50)
    assert near.lifts.shape == (len(points), 3, 0)
    np.testing.assert_array_equal(
        near.between(everyone, everyone),
        near_correction(cube, points).between(everyone, everyone),
    )


def test_other_points_are_lifted_alike(bar):
    points, near = bearing_points(bar)
    np.testing.assert_allclose(
        carried_over(points, near.lifts, points), near.lifts, atol=1e-6 * np.abs(near.lifts).max()
    )


def test_a_hand_presses_the_points_that_a_floor_presses():
    """Between two sets of points there is no near field: both on one edge would give energy."""
    for number in (CUBE, BAR, SLAB):
        body = shapes()[number]
        assert pressing_points(body, plate(0.04, 0.04)) is bearing_points(body)


def test_the_tick_holds_the_energy_that_the_formula_has(bar):
    """A smooth pinch askew, so that hands press along edges of the bar."""
    turn = np.deg2rad(4.0)
    hands = [(plate(0.04, 0.1), _looking(side, turn * side)) for side in (-1.0, 1.0)]
    none = RestSettings(friction=0.0, gravity=(0.0, 0.0, 0.0))
    resting = Resting(bar, [], hands, settings=none)
    for step in range(1, 30):
        resting.lead([_moved(hands[0][1], 2e-4 * step), _moved(hands[1][1], -2e-4 * step)])
        rest = resting.step()
    points, near = bearing_points(bar)
    numbers, forces = [], []
    for told in resting._native.touches():
        away = np.linalg.norm(points.positions[:, None] - told["places"], axis=2)
        numbers.append(away.argmin(axis=0))
        push = -np.asarray(told["force"]) / np.linalg.norm(told["force"])
        forces.append(told["pushes"][:, None] * push)
    number, force = np.concatenate(numbers), np.concatenate(forces)
    assert len(number) > 10
    blocks = point_compliance(bar, points, number, number, near)
    energy = 0.5 * np.einsum("ix,ijxy,jy->", force, blocks, force) / bar.modulus(None)
    assert rest.elastic == pytest.approx(energy, rel=1e-4)


def _looking(side, turn):
    """Where a plate waits beside the bar, 5 mm out, turned about its long axis."""
    ahead = np.array([np.sin(turn), side * np.cos(turn), 0.0])
    looks = np.column_stack([np.cross([0.0, 0.0, 1.0], ahead), [0.0, 0.0, 1.0], ahead])
    return Pose.at([0.01, 0.015 + side * 0.02, 0.04], looks)


def _moved(pose, by):
    return Pose(pose.position + np.array([0.0, by, 0.0]), pose.rotation)
