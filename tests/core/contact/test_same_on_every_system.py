"""Stored tetrahedra give the same force on every system; the figures were computed on Linux."""

import numpy as np
import pytest
from bodies.shared import highest_place

from palpate.core.contact.place import nearest_place
from palpate.core.contact.single_press import press_points, press_tool, set_down
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere

DEPTH = 0.003
"""Along the axis, inwards, m."""
# Of a point, of a second one beside it at the same time, and of a fingertip where the surface is
# not flat: on a flat one rounding decides between contact points that are equally deep. N.
FORCES = {
    "cube": [
        [-0.07537551184171312, -0.02053899514488893, 0.38920455172429014],
        [0.11505834302509999, 0.03100568221496174, 0.3080256945205509],
    ],
    "mouse": [
        [0.0024534611863707544, 0.0014700143308010306, 0.015946097004335236],
        [9.118330349570761e-05, 0.0010513002547478214, 0.023115213719671922],
        [0.00014825970629551687, 0.0013312236965030374, 0.01919558215284743],
    ],
}


def forces(body):
    """Forces (3, 3) on two points that press at once, and on a fingertip after them, N."""
    place = nearest_place(body, highest_place(body))
    deep = DEPTH * place.axis
    aside = place.position + np.array([0.01, 0.002, 0.0])
    points = press_points(body, [place.position, aside], [deep, 0.7 * deep])
    tip = sphere(0.008)
    above = set_down(body, tip, place)
    touch = press_tool(body, tip, Pose(above.position + deep, above.rotation))
    return np.array([*(point.force for point in points), touch.force])


@pytest.mark.parametrize("name", ["cube", "mouse"])
def test_points_and_a_fingertip_feel_what_they_feel_elsewhere(name, request):
    stored = np.array(FORCES[name])
    felt = forces(request.getfixturevalue(name))[: len(stored)]
    assert np.abs(felt - stored).max() <= 1e-9 * np.abs(stored).max()
