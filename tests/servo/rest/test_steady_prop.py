"""A body that nothing holds but a hand that steadies it, in the servo."""

import numpy as np
import pytest
from bodies.laid import TIP

from palpate.core.contact.tool.pose import Pose
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.core.servo.firming import Firming
from palpate.core.shape.firm_rest import settle_firmly
from palpate.core.shape.shapes import shape

START, DEPTH = np.array([-0.0105, 0.027, 0.03]), 0.004
DOWN = (0.0, 0.0, -9.81)


def inward(depth, ticks):
    return np.repeat((START + np.array([depth, 0.0, 0.0]))[None, None], ticks, 0)


def pressed(laid, law):
    """Without a clock."""
    settings = laid.settings(gravity=DOWN, steady=True)
    resting = Resting(laid.body, [Floor()], [(TIP, Pose.at(START))], settings=settings)
    resting.settle()
    resting.lead([Pose.at(START + np.array([DEPTH, 0.0, 0.0]))])
    made = shape(laid.body, law)
    (rest,) = settle_firmly(resting, [made])
    return rest, made, settings


def steady_servo(laid):
    servo = laid.servo(START, tip=TIP, floors=[Floor()], gravity=DOWN, steady=True)
    servo.follow(inward(0.0, 300))
    servo.follow(inward(DEPTH, 3000))
    return servo


def test_it_is_pressed_from_the_side_as_without_a_clock(laid):
    rest, _, _ = pressed(laid, "linear")
    shot = steady_servo(laid).snapshot()
    position, turn = shot.placement
    np.testing.assert_allclose(turn, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(position[:2], 0.0, atol=1e-12)
    np.testing.assert_allclose(position, rest.placement.position, atol=1e-6)
    force = rest.tools[0].force
    assert force[0] < -0.3
    np.testing.assert_allclose(shot.fingers[0].contact_force, force, atol=1e-4 * abs(force[0]))


def test_by_its_law_it_is_as_firm_as_without_a_clock(laid, eventually):
    rest, made, settings = pressed(laid, "real")
    servo = steady_servo(laid)
    linear = servo.snapshot().fingers[0].contact_force[0]
    firming = Firming(servo, laid.body, TIP, supports=[Floor()], let_go=settings.let_go)

    def rests():
        before = servo.snapshot().firmness
        firming.follow(servo.snapshot().seen_from_body(), made, laid.body.young_modulus)
        servo.follow(inward(DEPTH, 600))
        return not firming.looks and servo.snapshot().firmness == pytest.approx(before, rel=1e-6)

    eventually(rests, "the firmness of the press")
    firming.close()
    made.close()
    force = rest.tools[0].force
    assert abs(force[0] / linear - 1.0) > 5e-3
    np.testing.assert_allclose(
        servo.snapshot().fingers[0].contact_force, force, atol=1e-2 * abs(linear)
    )


def test_in_and_out_gives_nothing(laid):
    servo = laid.servo(START, tip=TIP, floors=[Floor()], gravity=DOWN, steady=True)
    servo.follow(inward(0.0, 600))
    depths = DEPTH * np.sin(np.linspace(0.0, np.pi, 4000)) ** 2
    path = START + depths[:, None] * [1.0, 0.0, 0.0]
    forces = servo.sent(path[:, None])[:, 0]
    assert np.abs(forces).max() > 0.3
    given = np.einsum("ta,ta->t", forces[1:], np.diff(path, axis=0)).sum()
    assert given < 1e-3 * np.abs(forces).max() * DEPTH / 2
