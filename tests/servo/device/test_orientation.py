"""How a device's stylus is turned, from the hand that turns it to the servo's thread."""

import math
from types import SimpleNamespace

import numpy as np
import palpate_servo
import pytest
from link_vectors import VECTORS
from palpate_servo import harness

from palpate.core.servo import link
from palpate.core.servo.settings import Settings
from palpate.simulated.attack.target import ABOVE, YOUNG_MODULUS, cube
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.hand.quaternion import about
from palpate.simulated.simulated_process import SimulatedDevice

TOLD = [vector for vector in VECTORS["messages"] if vector["type"] == "orientation"]
HELLO = link.DeviceHello("Turning", 3, 3.0, (0.1, 0.1, 0.1), 1000, link.PROTOCOL)


def state(sequence):
    x, y, z = (round(metres * 1e6) for metres in ABOVE)
    return link.encode(link.State(sequence, 1000 * sequence, (x, y, z), taken=0))


@pytest.fixture
def servo():
    servo = harness.SteppedServo(cube(), Settings(YOUNG_MODULUS))
    servo.tick()
    servo.tick(link.encode(HELLO))
    return servo


def rotation(quaternion):
    """Matrix of a quaternion, column by column: where q e q* is."""
    w, x, y, z = np.array(quaternion) / np.linalg.norm(quaternion)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross


QUARTER = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""x to y, y to -x."""


def orientations(servo):
    """Paired, unpaired, refused, lost, and what was no message."""
    counters = servo.counters()["link"]
    names = ("orientations", *(f"orientations_{name}" for name in ("unpaired", "refused", "lost")))
    return [counters[name] for name in (*names, "unknown")]


@pytest.mark.parametrize("vector", TOLD, ids=lambda vector: vector["name"])
def test_the_orientations_of_the_vectors_are_taken_with_their_state(servo, vector):
    np.testing.assert_array_equal(servo.snapshot().orientation, np.eye(3))
    servo.tick(bytes.fromhex(vector["frame"]) + state(vector["fields"]["sequence"]))
    assert orientations(servo) == [1, 0, 0, 0, 0]
    expected = rotation(vector["fields"]["quaternion"])
    np.testing.assert_allclose(servo.snapshot().orientation, expected, atol=1e-12)


@pytest.mark.parametrize("vector", VECTORS["refused"], ids=lambda vector: vector["name"])
def test_what_is_none_by_the_vectors_is_refused_by_the_servo_too(servo, vector):
    payload = bytes.fromhex(vector["payload"])
    servo.tick(link.frame(payload) + state(258))
    is_message = len(payload) == 11
    assert orientations(servo) == [0, 0, int(is_message), 0, int(not is_message)]
    assert servo.snapshot().state == "ramping"
    np.testing.assert_array_equal(servo.snapshot().orientation, np.eye(3))


@pytest.fixture
def turning(started, eventually):
    """A device whose hand turns the stylus, and a servo that has found it."""

    def start(**options):
        device = started(SimulatedDevice(SimulatedOptions(rest=ABOVE, **options)))
        servo = started(palpate_servo.Servo(cube(), Settings(YOUNG_MODULUS)))
        servo.start(palpate_servo.LinkDevice(device.port))
        eventually(lambda: servo.snapshot().state == "free")
        return device, servo

    return start


@pytest.mark.in_time
def test_each_state_of_a_turning_device_has_its_orientation(turning, eventually):
    _, servo = turning(turning=30.0, turning_axis=(0.0, 1.0, 0.0), turning_period=1.0)
    degrees = []

    def seen():
        x = servo.snapshot().orientation[:, 0]
        degrees.append(math.degrees(math.atan2(-x[2], x[0])))
        return servo.counters()["link"]["orientations"] > 1500

    eventually(seen)
    servo.stop()
    assert max(degrees) == pytest.approx(30.0, abs=0.5)
    assert min(degrees) == pytest.approx(0.0, abs=0.5)
    assert orientations(servo)[1:] == [0, 0, 0, 0]
    assert servo.counters()["link"]["orientations"] == servo.counters()["link"]["states"]


def test_how_the_hand_holds_the_stylus_arrives_in_the_body(turning, eventually):
    """The frame turns it as it turns the place, and the tool may be fixed to it at a turn."""
    device, servo = turning(turning=0.0)
    np.testing.assert_array_equal(servo.snapshot().orientation, np.eye(3))
    held, fixed = about((1.0, 2.0, -1.0), 1.2), rotation(about((0.0, 0.0, 1.0), 0.4))
    frame = SimpleNamespace(rotation=QUARTER, translation=(0.0, 0.0, 0.0), scale=1.0)
    servo.set(Settings(YOUNG_MODULUS, frames=[frame], orientations=[fixed]))
    device.turn_hand(held, 0.3)
    expected = QUARTER @ rotation(held) @ fixed
    eventually(lambda: np.allclose(servo.snapshot().orientation, expected, atol=1e-4))
    (finger,) = servo.snapshot().fingers
    np.testing.assert_allclose(finger.orientation, expected, atol=1e-4)
    np.testing.assert_allclose(finger.probe, QUARTER @ np.array(ABOVE), atol=2e-5)
