"""A hand steadies a body: it neither slides nor turns, and its floor bears it as before."""

import numpy as np
import pytest
from bodies.free_shapes import free_block
from scipy.spatial.transform import Rotation

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.pile.pile import Pile
from palpate.core.pile.pile_settings import PileSettings
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.core.shape.firm_rest import settle_firmly
from palpate.core.shape.shapes import shape

RADIUS = 0.012
TIP = sphere(RADIUS)
DOWN, ASIDE = (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)
MIDDLE = (0.025, 0.025, 0.05)
FACE = (0.0, 0.022, 0.03)
DEPTH = 0.004


def pressed(body, at, way, *, steady=True, turn=None, gravity=9.81, law="linear"):
    """The body on a floor, all of the world turned, where a fingertip went in at a place."""
    turn = Rotation.identity() if turn is None else turn
    start = np.subtract(at, np.multiply(RADIUS + 1e-4, way))
    settings = RestSettings(gravity=tuple(turn.apply([0.0, 0.0, -gravity])), steady=steady)
    resting = Resting(
        body,
        [Floor(friction=0.5, up=tuple(turn.apply([0.0, 0.0, 1.0])))],
        [(TIP, Pose.at(turn.apply(start)))],
        placement=Pose(np.zeros(3), turn.as_matrix()),
        settings=settings,
    )
    resting.settle()
    resting.lead([Pose.at(turn.apply(start + np.multiply(DEPTH + 1e-4, way)))])
    made = shape(body, law)
    (rest,) = settle_firmly(resting, [made])
    made.close()
    return rest


@pytest.mark.parametrize("law", ["linear", "real"])
@pytest.mark.parametrize("turn", [None, Rotation.from_rotvec([0.7, -0.4, 1.1])])
def test_a_push_from_the_side_moves_it_along_gravity_alone(cube, law, turn):
    rest = pressed(cube, FACE, ASIDE, law=law, turn=turn)
    turn = Rotation.identity() if turn is None else turn
    np.testing.assert_allclose(rest.placement.rotation, turn.as_matrix(), atol=1e-12)
    gone = turn.inv().apply(rest.placement.position)
    np.testing.assert_allclose(gone[:2], 0.0, atol=1e-12)
    assert 0.0 < abs(gone[2]) < 1e-3
    # It is dented there by nearly as much as the fingertip went in.
    push = turn.inv().apply(rest.tools[0].force)
    assert push[0] < -0.5
    assert np.abs(rest.displacements()[:, 0]).max() > 0.3 * DEPTH


@pytest.mark.parametrize("law", ["linear", "real"])
@pytest.mark.parametrize(("at", "way"), [(MIDDLE, DOWN), (FACE, ASIDE)])
def test_the_floor_bears_what_presses_down_and_the_weight(cube, law, at, way):
    rest = pressed(cube, at, way, law=law)
    weight = cube.mass * 9.81
    up = rest.tools[0].force[2] + rest.supports[0].force[2]
    assert up == pytest.approx(-weight, abs=1e-6 * max(weight, abs(rest.tools[0].force[2])))


def test_what_balances_by_itself_is_as_without_a_hand(cube):
    steady, alone = (pressed(cube, MIDDLE, DOWN, steady=one) for one in (True, False))
    force = alone.tools[0].force
    np.testing.assert_allclose(steady.tools[0].force, force, atol=5e-3 * force[2])
    span = np.abs(alone.displacements()).max()
    np.testing.assert_allclose(steady.surface(), alone.surface(), atol=2e-2 * span)


def test_beside_its_middle_it_does_not_lean(cube):
    beside = (0.008, 0.025, 0.05)
    steady, alone = (pressed(cube, beside, DOWN, steady=one) for one in (True, False))
    assert np.abs(alone.placement.rotation - np.eye(3)).max() > 1e-3
    np.testing.assert_allclose(steady.placement.rotation, np.eye(3), atol=1e-12)
    assert steady.tools[0].force[2] > alone.tools[0].force[2]


def test_without_gravity_it_stays_where_it_is(cube):
    rest = pressed(cube, FACE, ASIDE, gravity=0.0)
    np.testing.assert_allclose(rest.placement.position, 0.0, atol=1e-15)
    assert rest.tools[0].force[0] < -0.5


def test_the_force_is_the_slope_of_what_it_holds(cube):
    """By states at rest, of which no energy is lost: work of the finger over a small way."""
    step = 1e-5

    def at(depth):
        settings = RestSettings(friction=0.0, steady=True)
        start = np.array([-RADIUS - 1e-4, 0.022, 0.03])
        resting = Resting(cube, [Floor(friction=0.0)], [(TIP, Pose.at(start))], settings=settings)
        resting.settle()
        resting.lead([Pose.at(start + np.array([1e-4 + depth, 0.0, 0.0]))])
        rest = resting.settle()
        return rest.elastic + 9.81 * cube.mass * rest.centre[2], -rest.tools[0].force[0]

    (before, _), (_, force), (after, _) = (at(DEPTH + sign * step) for sign in (-1, 0, 1))
    assert (after - before) / (2.0 * step) == pytest.approx(force, rel=5e-3)


def test_of_a_pile_it_steadies_those_that_are_named(cube):
    small = free_block((0.03, 0.03, 0.03), (3, 3, 3))
    above = Pose.at([0.01, 0.01, 0.0505])
    start = np.array([0.01 - RADIUS - 1e-4, 0.025, 0.07])

    def pushed(steady):
        pile = Pile(
            [(small, above), (cube, Pose.at(np.zeros(3)))],
            [Floor(friction=0.8)],
            [(TIP, Pose.at(start))],
            settings=PileSettings(steady=steady),
        )
        pile.settle()
        pile.lead([Pose.at(start + np.array([0.004, 0.0, 0.0]))])
        return pile.settle()

    upper, lower = pushed((0,))
    np.testing.assert_allclose(upper.placement.rotation, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(upper.placement.position[:2], 0.01, atol=1e-12)
    assert upper.let_go is not None
    assert lower.let_go is None
    weight = (small.mass + cube.mass) * 9.81
    up = upper.tools[0].force[2] + lower.supports[0].force[2]
    assert up == pytest.approx(-weight, abs=1e-5 * weight)
    alone, _ = pushed(())
    assert alone.placement.position[0] > 0.011
