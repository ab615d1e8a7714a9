"""An elastic ball on a floor, under its weight and under a plate: Hertz on each side.

Its ends come nearer to its middle by A F^(2/3) + B F: the first term is that of the contact (Hertz,
1882), the second what the ball gives way beyond two half-spaces. A is fitted. Triangles are up to
two thirds as wide as the contact, and flat: contact points lie on what they stand for. Between
plates the force is also that of an axially symmetric solve by scikit-fem, each depth by itself.
"""

import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.free_shapes import NO_PINS, free_ball, shell_ball
from scipy.spatial.transform import Rotation

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor, Support

RADIUS, MODULUS = 0.025, 100_000.0
PLANE_STRAIN = MODULUS / (1.0 - 0.3**2)
HERTZ = (9.0 / (16.0 * PLANE_STRAIN**2 * RADIUS)) ** (1.0 / 3.0)
# Depth, m, and force, N, of benchmarks/measuring/contact/resting_ball.py, refined 7 times.
BETWEEN_PLATES = {0.0006: 0.12791, 0.001: 0.28065, 0.0015: 0.52636, 0.002: 0.82509}
# The same of a softer ball.
SOFT_RADIUS, SOFT_MODULUS, SOFT_RATIO = 0.03, 10_000.0, 0.45
SOFT_BETWEEN_PLATES = {0.002: 0.099365, 0.004: 0.290917}


@pytest.fixture(scope="module")
def ball():
    return free_ball(RADIUS, 16, MODULUS)


def settings(gravity, spacing):
    return RestSettings(gravity=(0.0, 0.0, -gravity), friction=0.0, spacing=spacing)


def hertz_share(forces, approaches):
    """Fitted A over Hertz's."""
    forces = np.array(forces)
    terms = np.column_stack([forces ** (2.0 / 3.0), forces])
    scaled = terms / np.array(approaches)[:, None]
    fitted = np.linalg.lstsq(scaled, np.ones(len(forces)), rcond=None)[0]
    np.testing.assert_allclose(scaled @ fitted, 1.0, atol=0.015)
    return fitted[0] / HERTZ


def test_under_its_weight(ball):
    forces, approaches = [], []
    for gravity in (2.5, 5.0, 10.0, 20.0):
        # It would turn for ever so slowly to where its mesh is softest.
        resting = Resting(ball, [Floor(friction=0.3)], settings=settings(gravity, 0.0008))
        for _ in range(100):
            rest = resting.step(0.005)
        forces.append(ball.mass * gravity)
        assert -rest.supports[0].force[2] == pytest.approx(forces[-1], rel=1e-4)
        approaches.append(ball.inertia.centre[2] - rest.centre[2])
    assert hertz_share(forces, approaches) == pytest.approx(1.0, abs=0.03)


def test_between_floor_and_plate(ball):
    forces, approaches = [], []
    for depth, force in BETWEEN_PLATES.items():
        top = Support(plate(0.1, 0.1), Pose.at([0.0, 0.0, 2.0 * RADIUS + 2e-4]), friction=0.3)
        resting = Resting(ball, [Floor(friction=0.3), top], settings=settings(1e-6, 0.0012))
        for share in [*np.linspace(0.0, 1.0, 20), *np.ones(20)]:
            height = 2.0 * RADIUS + (1.0 - share) * 2e-4 - share * depth
            resting.move_support(1, Pose.at([0.0, 0.0, height]))
            rest = resting.step(0.005)
        floor, top_touch = rest.supports
        assert top_touch.force[2] == pytest.approx(-floor.force[2], rel=1e-5)
        assert top_touch.force[2] == pytest.approx(force, rel=0.03)
        forces.append(top_touch.force[2])
        approaches.append(0.5 * depth)
    assert hertz_share(forces, approaches) == pytest.approx(1.0, abs=0.03)


def test_smoothed_elements_that_are_coarser_inside_than_on_the_surface():
    """They give way too far within three surface edges of a force: believed there they make
    the ball 3 % too soft in the mean, as its patch is hardly wider.
    """
    mesh = shell_ball(SOFT_RADIUS, 500, 1.6)
    ball = baked_body(mesh, NO_PINS, SOFT_RATIO, SOFT_MODULUS, "smoothed", density=1000.0)
    ratios = []
    for seed in range(3):
        turn = Rotation.random(random_state=np.random.default_rng(seed)).as_matrix()
        resting = Resting(
            ball,
            [Floor(friction=0.05)],
            [(plate(0.05, 0.05), Pose.at([0.0, 0.0, 2.0 * SOFT_RADIUS + 2e-4]))],
            placement=Pose.at([0.0, 0.0, SOFT_RADIUS + 4e-5], turn),
            settings=RestSettings(gravity=(0.0, 0.0, -1e-6), friction=0.05),
        )
        resting.step()
        for depth, force in SOFT_BETWEEN_PLATES.items():
            resting.lead([Pose.at([0.0, 0.0, 2.0 * SOFT_RADIUS - depth])])
            ratios.append(resting.settle().tools[0].force[2] / force)
    np.testing.assert_allclose(ratios, 1.0, atol=0.03)
    np.testing.assert_allclose(np.reshape(ratios, (3, 2)).mean(axis=0), 1.0, atol=0.015)
