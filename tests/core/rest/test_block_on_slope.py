"""A block on a slope slides at the angle of friction, and tips where its weight leaves its foot."""

import numpy as np
import pytest
from bodies.free_shapes import free_block

from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor

FRICTION = 0.5


def on_slope(body, angle, friction, **more):
    """Gravity leans towards x by the angle, rad."""
    gravity = (9.81 * np.sin(angle), 0.0, -9.81 * np.cos(angle))
    settings = RestSettings(gravity=gravity, **more)
    return Resting(body, [Floor(friction=friction)], settings=settings)


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_slides_at_the_angle_of_friction(cube, share):
    angle = np.arctan(FRICTION) * share
    block = on_slope(cube, angle, FRICTION)
    for _ in range(400):
        block.step(1e-3)
    before = block.rest.centre
    for _ in range(200):
        block.step(1e-3)
    speed = (block.rest.centre - before)[0] / 0.2
    # Beyond it, at the speed where drag takes what friction leaves.
    expected = 0.05 * 9.81 * (np.sin(angle) - FRICTION * np.cos(angle))
    assert speed == pytest.approx(max(expected, 0.0), abs=0.01 * abs(expected))


@pytest.mark.parametrize(("beyond", "tips"), [(-1.0, False), (1.0, True)])
def test_tips_where_its_weight_leaves_its_foot(beyond, tips):
    tall = free_block((0.03, 0.03, 0.06), (3, 3, 6), young_modulus=3e6)
    angle = np.arctan(0.5) + np.radians(beyond)
    block = on_slope(tall, angle, 2.0)
    rest = block.settle()
    lies = abs(rest.placement.rotation[2, 2]) < 0.1
    assert lies == tips
    assert rest.centre[2] == pytest.approx(0.015 if tips else 0.03, abs=1e-3)
