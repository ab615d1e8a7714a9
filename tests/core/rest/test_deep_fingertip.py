"""A fingertip that goes deeper than its radius into a body on a floor stays on top of it."""

import numpy as np

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor

RADIUS = 0.006
DEPTHS = (0.005, 0.008, 0.011, 0.014)


def test_a_body_does_not_slip_round_a_fingertip_that_presses_it_down(cube):
    above = np.array([0.027, 0.024, 0.0505 + RADIUS])
    finger = (sphere(RADIUS), Pose.at(above))
    resting = Resting(cube, [Floor(friction=0.5)], [finger], settings=RestSettings(friction=0.0))
    resting.settle()
    before = 0.0
    for depth in DEPTHS:
        resting.lead([Pose.at(above - [0.0, 0.0, depth])])
        force = resting.settle().tools[0].force
        assert force[2] > max(before, 0.98 * np.linalg.norm(force))
        before = force[2]
