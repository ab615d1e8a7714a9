"""What a hand gets from a body that nobody holds, it has put in, or the weight has."""

import numpy as np
import pytest
from bodies.laid import DOWN, TIP

from palpate.core.contact.tool.pose import Pose
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor


def in_and_out(start, depth, steps):
    """A way of a finger down and up again, (steps, 3), m."""
    down = depth * np.sin(np.linspace(0.0, np.pi, steps)) ** 2
    return start - down[:, None] * [0.0, 0.0, 1.0]


def works(forces, path):
    """Work of the finger in each step, J."""
    return -0.5 * np.einsum("ta,ta->t", forces[1:] + forces[:-1], np.diff(path, axis=0))


def test_a_closed_way_of_a_tool_in_the_servo_gives_back_what_was_put_in(laid):
    start = np.array([0.035, 0.027, 0.0605])
    servo = laid.servo(start, tip=TIP)
    servo.follow(np.repeat(start[None], 500, 0)[:, None])
    path = in_and_out(start, 0.003, 12_000)
    work = works(servo.follow(path[:, None])[0][:, 0], path)
    assert abs(work.sum()) < 1e-4 * work[work > 0.0].sum()


def test_a_closed_way_of_a_tool_without_a_clock_gives_back_what_was_put_in(laid):
    start = np.array([0.035, 0.027, 0.0605])
    tools = [(TIP, Pose.at(start))]
    resting = Resting(laid.body, laid.corner(), tools, settings=laid.settings())
    resting.settle()
    path = in_and_out(start, 0.003, 41)
    forces = []
    for place in path:
        resting.lead([Pose.at(place)])
        forces.append(resting.settle().tools[0].force)
    work = works(np.array(forces), path)
    assert abs(work.sum()) < 1e-4 * work[work > 0.0].sum()


@pytest.mark.parametrize("tip", [TIP, None])
def test_a_body_that_falls_on_a_finger_at_rest_is_not_braked(laid, tip):
    """It sinks onto the finger, that bears part of it, and does so without a limiter; the finger
    lets it down then and gets no more than the weight's work.
    """
    below = np.array([0.026, 0.024, -0.0205 if tip is not None else -0.0105])
    floors = [Floor(height=-0.02)]
    servo = laid.servo(below, tip=tip, friction=0.5, floors=floors, gravity=DOWN, max_force=50.0)
    path = np.repeat(below[None], 800, 0)
    sent = servo.sent(path[:, None])[:, 0]
    assert np.linalg.norm(sent[-1]) > 0.1
    assert servo.snapshot().limited == ""


def test_a_hand_that_lets_a_body_down_gets_no_more_than_its_weight_does(laid):
    start = np.array([0.026, 0.024, -0.0105])
    servo = laid.servo(start, tip=TIP, friction=0.5, floors=[Floor(height=-0.5)], gravity=DOWN)
    servo.follow(np.repeat(start[None], 400, 0)[:, None])
    before = servo.snapshot().placement
    path = start - np.linspace(0.0, 0.02, 800)[:, None] * [0.0, 0.0, 1.0]
    forces = servo.follow(path[:, None])[0][:, 0]
    after = servo.snapshot().placement
    centre = laid.body.inertia.centre
    fallen = [position + rotation @ centre for position, rotation in (before, after)]
    weight = laid.body.mass * np.array(DOWN)
    assert -works(forces, path).sum() <= weight @ (fallen[1] - fallen[0]) + 1e-6
