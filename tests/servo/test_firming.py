"""A running servo that comes to press as firmly as the body's own law."""

import numpy as np
import pytest

from palpate.core.contact.single_press import touch_nearest
from palpate.core.servo.firming import Firming
from palpate.core.servo.session import Pointer, native_body, servo_on
from palpate.core.servo.settings import Settings
from palpate.core.shape.felt import felt
from palpate.core.shape.shapes import LinearShape, shape

ABOVE, DEEP, DEPTH = (0.025, 0.025, 0.051), (0.025, 0.025, 0.038), 0.012


@pytest.fixture
def servo(cube_body):
    settings = Settings(cube_body.young_modulus, max_force=1e3)
    running = servo_on(native_body(cube_body), settings)
    running.start(Pointer(ABOVE))
    yield running
    running.stop()


@pytest.fixture
def real(cube_body):
    made = shape(cube_body, "real")
    made.wait_for(np.zeros(0, dtype=np.int64))
    yield made
    made.close()


def true_touches(body, shape):
    linear = touch_nearest(body, (0.025, 0.025, 0.05), (0.0, 0.0, -DEPTH))
    found = felt(shape, [linear], body.young_modulus)
    assert found.firmness.is_whole
    return linear, found.touches[0]


def test_it_presses_as_the_command_line_does(cube_body, servo, real, eventually):
    firming = Firming(servo, cube_body)
    linear, true = true_touches(cube_body, real)
    share = np.linalg.norm(true.force) / np.linalg.norm(linear.force)
    assert abs(share - 1.0) > 0.02
    servo.set_target(DEEP)

    def is_firm():
        snapshot = servo.snapshot()
        firming.follow(snapshot, real, cube_body.young_modulus)
        force = snapshot.contact_force
        return np.linalg.norm(force - true.force) < 0.02 * np.linalg.norm(true.force)

    eventually(is_firm, "the force of the material's law")

    def is_linear():
        snapshot = servo.snapshot()
        firming.follow(snapshot, LinearShape(cube_body), cube_body.young_modulus)
        return np.allclose(snapshot.contact_force, linear.force, rtol=1e-6, atol=1e-9)

    eventually(is_linear, "the linear force again, of another shape")
    eventually(is_firm, "and the other one")
    servo.set_target(ABOVE)
    eventually(lambda: not servo.snapshot().touching)
    firming.follow(servo.snapshot(), real, cube_body.young_modulus)
    eventually(lambda: servo.snapshot().firmness == 1.0)
    firming.close()


def test_a_linear_shape_leaves_it_linear(cube_body, servo, real, eventually):
    firming = Firming(servo, cube_body)
    linear, _ = true_touches(cube_body, real)
    servo.set_target(DEEP)

    def is_there():
        snapshot = servo.snapshot()
        firming.follow(snapshot, LinearShape(cube_body), cube_body.young_modulus)
        return np.allclose(snapshot.contact_force, linear.force, rtol=1e-6, atol=1e-9)

    eventually(is_there, "the linear force")
    for _ in range(100):
        assert is_there()
    assert servo.snapshot().firmness == 1.0
    firming.close()
