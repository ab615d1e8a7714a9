"""The force on a finger does not jump where points of a support come or go."""

import numpy as np
import pytest

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor


def pressed_by_an_edge(cube, steps, friction):
    """Forces on a fingertip that presses a cube on a floor by an edge, so that its far side rises,
    (steps, 3), N; and how many points the floor presses.
    """
    heights = np.linspace(0.0582, 0.0535, steps)
    tip = (sphere(0.008), Pose.at([0.046, 0.026, heights[0]]))
    settings = RestSettings(gravity=(0.0, 0.0, -4.0), friction=friction)
    resting = Resting(cube, [Floor(friction=friction)], [tip], settings=settings)
    resting.settle()
    forces, borne = [], []
    for height in heights:
        resting.lead([Pose.at([0.046, 0.026, height])])
        rest = resting.step(0.4 / steps)
        forces.append(rest.tools[0].force)
        borne.append(len(rest.supports[0].pushes))
    return np.array(forces), np.array(borne)


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_points_of_a_floor_come_and_go_without_a_jump(cube, friction):
    changes, jumps = [], []
    for steps in (100, 400):
        forces, borne = pressed_by_an_edge(cube, steps, friction)
        assert borne.max() - borne.min() >= 5
        change = np.linalg.norm(np.diff(forces, axis=0), axis=1)
        change /= np.linalg.norm(forces, axis=1).max()
        changes.append(change.max())
        # What stands out of the changes beside it.
        jumps.append((change[1:-1] - np.maximum(change[:-2], change[2:])).max())
    assert changes[1] < 0.5 * changes[0]
    assert jumps[1] < 0.02
