"""Two balls pressed together between floor and plate.

By symmetry the plane between two equal ones is a smooth rigid one: each is as if alone between two
plates. That force is known from an axially symmetric solve by scikit-fem, and Hertz's joint modulus
with it.
"""

import pytest
from bodies.free_shapes import free_ball

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate
from palpate.core.pile.pile import Pile
from palpate.core.pile.pile_settings import PileSettings
from palpate.core.rest.support import Floor

RADIUS, MODULUS = 0.025, 100_000.0
# Depth of a plate on one ball, m, and force, N, of benchmarks/measuring/contact/resting_ball.py.
ONE_BALL = {0.0015: 0.52636, 0.002: 0.82509}


@pytest.fixture(scope="module")
def ball():
    return free_ball(RADIUS, 16, MODULUS)


def pressed(balls, heights, depth, spacing=0.0018):
    """A plate that has come down on the uppermost ball, by ``depth`` in all."""
    top = heights[-1] + 2.0 * RADIUS
    settings = PileSettings(friction=0.3, gravity=(0.0, 0.0, -1e-6), spacing=spacing)
    bodies = [(ball, Pose.at([0.0, 0.0, z])) for ball, z in zip(balls, heights, strict=True)]
    hand = [(plate(0.1, 0.1), Pose.at([0.0, 0.0, top + 2e-4]))]
    pile = Pile(bodies, [Floor(friction=0.3)], hand, settings=settings)
    pile.lead([Pose.at([0.0, 0.0, top - depth])])
    for _ in range(40):
        rests = pile.step(5e-3)
    return rests


@pytest.mark.parametrize("depth", ONE_BALL)
def test_two_equal_balls_are_each_as_on_a_rigid_plane(ball, depth):
    alone = pressed([ball], [0.0], depth)[0].tools[0].force[2]
    lower, upper = pressed([ball, ball], [0.0, 2.0 * RADIUS], 2.0 * depth)
    between = lower.others[1].force[2]
    assert between == pytest.approx(upper.tools[0].force[2], rel=1e-4)
    assert between == pytest.approx(-lower.supports[0].force[2], rel=1e-4)
    assert between == pytest.approx(alone, rel=0.015)
    assert between == pytest.approx(ONE_BALL[depth], rel=0.03)


def test_it_does_not_matter_which_comes_first(ball):
    """The finer of two bodies has the points, whatever its number."""
    fine = free_ball(RADIUS, 10, MODULUS)
    forces = []
    for first in (0, 1):
        bodies = [(ball, Pose.at([0.0, 0.0, 0.0])), (fine, Pose.at([0.0, 0.0, 2.0 * RADIUS]))]
        top = 4.0 * RADIUS
        settings = PileSettings(friction=0.3, gravity=(0.0, 0.0, -1e-6))
        ordered = bodies if first == 0 else bodies[::-1]
        hand = [(plate(0.1, 0.1), Pose.at([0.0, 0.0, top + 2e-4]))]
        pile = Pile(ordered, [Floor(friction=0.3)], hand, settings=settings)
        pile.lead([Pose.at([0.0, 0.0, top - 0.003])])
        for _ in range(30):
            rests = pile.step(5e-3)
        forces.append(rests[first].others[1 - first].force[2])
    assert forces[0] == pytest.approx(forces[1], rel=1e-6)
