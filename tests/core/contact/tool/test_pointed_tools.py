"""A cone on a wide base, pressed by its tip: points are where it can touch."""

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.convex_tool import convex
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate
from palpate.core.mesh.paper_cube import paper_cube

WIDTH, HALF_ANGLE = 0.04, np.radians(75.0)
EDGE, RATIO = 0.05, 0.3


def cone(upright=True):
    """Of 40 mm, its tip at its reference point."""
    turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    height = 0.5 * WIDTH / np.tan(HALF_ANGLE)
    base = [0.5 * WIDTH * np.cos(turn), 0.5 * WIDTH * np.sin(turn), np.full(24, height)]
    return convex(
        np.vstack([[0.0, 0.0, 0.0], np.column_stack(base)]) * (1, 1, 1 if upright else -1)
    )


@pytest.fixture(scope="module")
def cube():
    return baked_body(*paper_cube(EDGE, 8), RATIO, 1.0)


@pytest.mark.parametrize(("depth", "allowed"), [(0.0005, 0.15), (0.001, 0.1), (0.004, 0.1)])
def test_a_blunt_cone_is_felt_alike_wherever_its_tip_is(cube, depth, allowed):
    """Sneddon 1965: F = 2/pi E* tan(half angle) d^2; the cube's end makes 4 % of it more."""
    tool = cone()
    tip = -tool.core[:, 2].min() + tool.radius
    expected = 2.0 / np.pi / (1.0 - RATIO**2) * np.tan(HALF_ANGLE) * depth**2
    for aside in np.random.default_rng(1).uniform(-0.003, 0.003, (8, 2)):
        place = [*(0.5 * EDGE + aside), EDGE + tip - depth]
        force = press_tool(cube, tool, Pose.at(place)).force[2]
        assert force == pytest.approx(expected, rel=allowed)


def test_points_are_close_for_a_point_in_either_direction_and_wide_for_a_face():
    assert cone(True).spacing == pytest.approx(cone(False).spacing)
    assert cone().spacing < 0.05 * WIDTH
    board = plate(0.016, 0.012)
    assert board.spacing == pytest.approx(0.125 * board.size)
