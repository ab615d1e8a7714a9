"""A body that nobody holds and that presses back as its law has it, in the servo."""

import numpy as np
import pytest
from bodies.laid import TIP
from ways.told_firmness import told

from palpate.core.contact.tool.pose import Pose
from palpate.core.rest.resting import Resting
from palpate.core.servo.firming import Firming
from palpate.core.shape.firm_rest import settle_firmly
from palpate.core.shape.shapes import shape

START = np.array([0.03, 0.027, 0.0605])
DEPTH = 0.004
# At the depth: 1 + s/4 + s^2/4 of its share, and 1 - s/3.
FIRMER, SOFTER = (0.25, 0.25), (-1 / 3, 0.0)
# How it gives way with time.
RELAXING = ((0.8, 0.02), (0.5, 0.1))


def down(depth, ticks):
    return np.repeat((START - [0.0, 0.0, depth])[None, None], ticks, 0)


def firm(servo, firmness, unit):
    servo.set_firmness(*told(firmness, unit))


def held_at(laid, depth):
    """Elastic energy, J/Pa, of the linear body between finger and floors."""
    servo = laid.servo(START, tip=TIP)
    servo.follow(down(0.0, 300))
    servo.follow(down(depth, 2000))
    return servo.snapshot().held


@pytest.mark.parametrize("firmness", [FIRMER, SOFTER])
def test_finger_and_floors_press_so_many_times_as_firmly_and_the_weight_stays(laid, firmness):
    servo = laid.servo(START, tip=TIP)
    firm(servo, firmness, held_at(laid, DEPTH))
    servo.follow(down(0.0, 300))
    servo.follow(down(DEPTH, 3000))
    shot = servo.snapshot()
    times = 1.0 + sum(firmness)
    assert shot.firmness == pytest.approx(times, rel=0.02)
    # As a linear body that is so many times as firm, weight and all.
    resting = Resting(laid.body, laid.corner(), [(TIP, Pose.at(START))], settings=laid.settings())
    resting.firm([shot.firmness])
    resting.settle()
    resting.lead([Pose.at(START - [0.0, 0.0, DEPTH])])
    rest = resting.settle()
    force = rest.tools[0].force
    np.testing.assert_allclose(shot.fingers[0].contact_force, force, atol=1e-5 * force[2])
    weight = laid.body.mass * np.array(laid.settings().gravity)
    borne = shot.placement[1] @ shot.borne_forces.sum(axis=0)
    np.testing.assert_allclose(borne + weight, shot.fingers[0].contact_force, atol=1e-5 * force[2])


@pytest.mark.parametrize("firmness", [FIRMER, SOFTER])
@pytest.mark.parametrize("ticks", [400, 4000])
@pytest.mark.parametrize(("max_force", "relaxation"), [(None, ()), (50.0, ()), (None, RELAXING)])
def test_in_and_out_gives_nothing(laid, firmness, ticks, max_force, relaxation):
    servo = laid.servo(START, tip=TIP, max_force=max_force, relaxation=relaxation)
    firm(servo, firmness, held_at(laid, DEPTH))
    servo.follow(down(0.0, 600))
    # In, to and fro there until another firmness has come, and out again.
    ways = 0.5 * DEPTH * np.sin(np.linspace(0.0, np.pi, 2 * ticks)) ** 2
    ways[ticks:] += 0.5 * DEPTH * np.sin(np.linspace(0.0, 3 * np.pi, ticks)) ** 2
    path = START - ways[:, None] * [0.0, 0.0, 1.0]
    forces = servo.sent(path[:, None])[:, 0]
    assert np.abs(forces).max() > 0.5
    given = np.einsum("ta,ta->t", forces[1:], np.diff(path, axis=0)).sum()
    assert given < 1e-3 * np.abs(forces).max() * DEPTH / 2


@pytest.mark.parametrize("relaxation", [(), RELAXING])
def test_at_rest_it_presses_as_without_a_clock(laid, eventually, relaxation):
    body = laid.body
    made = shape(body, "real")
    made.wait_for(np.zeros(0, dtype=np.int64))
    resting = Resting(body, laid.corner(), [(TIP, Pose.at(START))], settings=laid.settings())
    resting.settle()
    resting.lead([Pose.at(START - [0.0, 0.0, DEPTH])])
    linear = resting.settle().tools[0].force
    (rest,) = settle_firmly(resting, [made])
    servo = laid.servo(START, tip=TIP, relaxation=relaxation)
    servo.follow(down(0.0, 300))
    servo.follow(down(DEPTH, 2000))
    firming = Firming(servo, body, TIP, supports=laid.corner())

    def rests():
        before = servo.snapshot().firmness
        firming.follow(servo.snapshot().seen_from_body(), made, body.young_modulus)
        servo.follow(down(DEPTH, 600))
        return not firming.looks and servo.snapshot().firmness == pytest.approx(before, rel=1e-6)

    eventually(rests, "the firmness of the press")
    firming.close()
    made.close()
    force = servo.snapshot().fingers[0].contact_force
    assert abs(rest.tools[0].force[2] / linear[2] - 1.0) > 5e-3
    np.testing.assert_allclose(force, rest.tools[0].force, atol=5e-3 * linear[2])
