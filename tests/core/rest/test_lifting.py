"""Two plates pinch a cube and lift it: friction carries it, or it falls out."""

import numpy as np
import pytest

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor

# Working faces look inwards.
LEFT = np.column_stack([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]])
RIGHT = np.column_stack([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
AIR, SQUEEZE, LIFT = 0.001, 0.0015, 0.04


def pinch(gap, height):
    """Poses of the two plates about the middle of the cube, m off its sides and over its place."""
    middle = 0.025 + height
    return [
        Pose.at([-gap, 0.025, middle], LEFT),
        Pose.at([0.05 + gap, 0.025, middle], RIGHT),
    ]


def lifted(cube, friction, gravity=9.81):
    """The cube after it was pinched on the floor, and hands went up."""
    hand = plate(0.04, 0.04)
    settings = RestSettings(friction=friction, gravity=(0.0, 0.0, -gravity))
    tools = [(hand, pose) for pose in pinch(AIR, 0.0)]
    resting = Resting(cube, [Floor(friction=0.3)], tools, settings=settings)
    resting.settle()
    resting.lead(pinch(-SQUEEZE, 0.0))
    resting.settle()
    for height in np.linspace(0.0, LIFT, 51)[1:]:
        resting.lead(pinch(-SQUEEZE, height))
        resting.step(5e-3)
    return resting


def test_friction_carries_it(cube):
    resting = lifted(cube, 0.5)
    rest = resting.settle()
    assert rest.centre[2] == pytest.approx(0.025 + LIFT, abs=2e-3)
    assert not rest.supports[0].force.any()
    weight = cube.mass * 9.81
    carried = -sum(touch.force for touch in rest.tools)
    np.testing.assert_allclose(carried, [0.0, 0.0, weight], atol=1e-6 * weight)


@pytest.mark.at_length
def test_it_falls_out_where_friction_is_too_small(cube):
    held = lifted(cube, 0.5).settle()
    push = min(np.sum(touch.pushes) for touch in held.tools)
    # Half of what two hands of that push need.
    friction = 0.5 * cube.mass * 9.81 / (2.0 * push)
    rest = lifted(cube, friction).settle()
    assert rest.centre[2] < 0.026
    assert -rest.supports[0].force[2] > 0.4 * cube.mass * 9.81
