"""The simulated 2DIY's geometry: by construction, by energy, and by the makers' figures."""

import cmath
import itertools
import math

import pytest

from palpate.core.errors import PalpateError
from palpate.core.servo.haply_arm import FiveBar
from palpate.core.servo.haply_models import HAPLY_MODELS, haply_model

every_model = pytest.mark.parametrize("model", HAPLY_MODELS.values(), ids=list(HAPLY_MODELS))


def places(model):
    """A grid of handle places around the workspace's middle, in the arm's axes."""
    for x, y in itertools.product((-0.04, -0.013, 0.0, 0.02, 0.04), (-0.025, -0.01, 0.0, 0.025)):
        yield model.centre + complex(x, y)


@every_model
def test_angles_and_handle_undo_each_other(model):
    for place in places(model):
        angles = model.arm.angles(place)
        assert abs(model.arm.handle(angles) - place) < 1e-12
        back = model.arm.angles(model.arm.handle(angles))
        assert back == pytest.approx(angles, abs=1e-9)


@every_model
def test_forearms_keep_their_length(model):
    for place in places(model):
        first, second = model.arm.angles(place)
        for motor, angle in ((0.0, first), (model.arm.spacing, second)):
            elbow = motor + cmath.rect(model.arm.proximal, angle)
            assert abs(place - elbow) == pytest.approx(model.arm.distal, abs=1e-12)


@every_model
def test_motors_do_the_work_that_arrives_at_the_handle(model):
    torques, turn = (0.05, -0.08), (2e-6, -1e-6)
    for place in places(model):
        angles = model.arm.angles(place)
        force = model.arm.handle_force(angles, torques)
        ahead = model.arm.handle((angles[0] + turn[0], angles[1] + turn[1]))
        behind = model.arm.handle((angles[0] - turn[0], angles[1] - turn[1]))
        arrived = (force.conjugate() * (ahead - behind)).real
        spent = 2.0 * (torques[0] * turn[0] + torques[1] * turn[1])
        assert arrived == pytest.approx(spent, rel=1e-5)


def test_the_rest_pose_is_where_the_makers_retracted_arm_is():
    # Elbows level at 168 and 12 degrees, 38 mm plus twice 70 cos 12 apart; the handle is above
    # their middle.
    half = 0.019 + 0.07 * math.cos(math.radians(12))
    height = 0.07 * math.sin(math.radians(12)) + math.sqrt(0.09**2 - half**2)
    assert haply_model("2diy-3.1").rest == pytest.approx((0.0, 0.095 - height, 0.0), abs=1e-12)


def test_what_cannot_be_reached_is_none():
    arm = FiveBar(0.07, 0.09, 0.038)
    assert arm.angles(0.2j) is None
    assert arm.angles(0.001 + 0.001j) is None
    assert FiveBar(0.07, 0.09, 0.5).handle((3.0, 0.0)) is None
    assert FiveBar(0.07, 0.09, 0.0).handle((1.5, 1.5)) is None
    assert FiveBar(0.07, 0.09, 0.5).handle_force((3.0, 0.0), (0.1, 0.1)) == 0.0


def test_an_unknown_model_is_refused_by_name():
    with pytest.raises(PalpateError, match=r"no model '2diy-9'.*2diy-3\.1"):
        haply_model("2diy-9")
