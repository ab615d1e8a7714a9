"""A running servo that comes to press as firmly as the body's own law."""

from concurrent.futures import Future

import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.soft_block import block_mesh
from palpate_servo.harness import SteppedFingers

from palpate.core.contact.place import nearest_place
from palpate.core.contact.single_press import press_tool, touch_at, touch_nearest
from palpate.core.contact.tool.pose import Pose, facing
from palpate.core.contact.tool.tools import plate, sphere
from palpate.core.servo import firming as firming_module
from palpate.core.servo.firming import Firming
from palpate.core.servo.session import Pointer, native_body, native_tool, servo_on
from palpate.core.servo.settings import Settings
from palpate.core.shape.felt import felt
from palpate.core.shape.rotation_strain.pressed import Firmness, Pressed
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


class AtOnce:
    """Does what it is given before it goes on, or where it ``waits`` when it is told to."""

    def __init__(self):
        self.waits, self.finish = False, None

    def submit(self, work, *given):
        done = Future()
        self.finish = lambda: done.set_result(work(*given))
        if not self.waits:
            self.finish()
        return done

    def shutdown(self, **_):
        pass


@pytest.fixture
def worker():
    return AtOnce()


@pytest.fixture
def looks(monkeypatch):
    """How many times as deep as the press each look was, of a body that is half as firm again."""
    made = []

    def look(shape, loads, young_modulus, ahead):
        made.append(ahead)
        return Pressed(Firmness((ahead**2,), (1.5,)), 1.0, None)

    monkeypatch.setattr(firming_module, "pressed_by", look)
    return made


@pytest.fixture
def pressed_to(cube_body, worker):
    """Leads a point to depths, m, by a place of the cube's top, and follows it at each of them; the
    firmness in the end.
    """
    native = native_body(cube_body, whole=True)
    above = np.array([[0.025, 0.025, 0.06]])
    servo = SteppedFingers(native, above, Settings(cube_body.young_modulus))
    firming = Firming(servo, cube_body, _worker=worker)
    linear = LinearShape(cube_body)

    def press(*depths, at=(0.025, 0.025), shape=linear):
        for depth in depths:
            servo.follow(np.tile([*at, 0.05 - depth], (500, 1, 1)))
            firming.follow(servo.snapshot(), shape, cube_body.young_modulus)
        return servo.snapshot().firmness

    return press


def test_it_looks_as_deep_as_fingers_will_be_when_the_next_look_begins(looks, pressed_to):
    pressed_to(-0.001, 0.001, 0.002, 0.003, 0.0031, 0.006, 0.0061)
    # Beyond the first one, of which it is not known yet, looks last from one call to the next.
    ways, takes = np.array([0.002, 0.001, 0.001, 0.0029]), np.array([0.1, 0.5, 0.5, 0.5])
    further = 1.2 * ways / 0.5 * takes
    assert looks == pytest.approx(1.0 + further / np.array([0.001, 0.002, 0.003, 0.006]))


def test_a_finger_that_came_to_rest_during_a_look_is_looked_at_where_it_rests(
    worker, looks, pressed_to
):
    worker.waits = True
    pressed_to(0.002, 0.008, 0.008)
    worker.finish()
    worker.waits = False
    pressed_to(0.008)
    assert looks[-1] == 1.0


def test_what_was_found_at_a_place_is_known_when_a_finger_comes_back(cube_body, looks, pressed_to):
    pressed_to(0.001, 0.002, 0.003, 0.004)
    firm = pressed_to(0.004, 0.004)
    assert looks[-1] == 1.0
    known = len(looks)
    again = pressed_to(-0.001, 0.001, 0.002, 0.004)
    assert len(looks) == known
    assert again == pytest.approx(firm, rel=0.1)
    assert again > 1.3
    pressed_to(0.006)
    assert len(looks) == known + 1
    pressed_to(-0.001, 0.002, at=(0.04, 0.012))
    assert len(looks) == known + 2
    pressed_to(-0.001, 0.002, shape=LinearShape(cube_body))
    assert len(looks) == known + 3


def test_beside_a_node_a_place_is_known_from_any_triangle(cube_body, looks, pressed_to):
    node, turns = np.array([0.025, 0.025]), np.arange(0.5, 6.0)
    around = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    assert np.isclose(cube_body.mesh.nodes[:, :2], node).all(axis=1).any()
    pressed_to(0.002, 0.004, 0.004, at=node + 0.0004 * around[0])
    known = len(looks)
    for way in around:
        assert pressed_to(-0.001, 0.002, 0.0021, at=node + 0.0004 * way) > 1.1
    assert len(looks) == known


def test_what_is_known_is_told_while_it_looks_elsewhere(worker, looks, pressed_to):
    here, there = (0.025, 0.025), (0.04, 0.012)
    pressed_to(0.002, 0.004, 0.004, at=here)
    worker.waits = True
    pressed_to(-0.001, 0.003, at=there)
    known = len(looks)
    assert pressed_to(-0.001, 0.003, 0.003, at=here) > 1.2
    assert len(looks) == known
    worker.finish()


# Tools, and how deep they go: a plate's edges come to rest in one way where they are in by no more
# than they are rounded.
TIPS = {
    "point": (None, 0.006),
    "sphere": (sphere(0.006), 0.003),
    "plate": (plate(0.012, 0.01), 0.0004),
}
TICKS = 400
# How the body relaxes, and how nearly its force in the end is that of one that does not: what it
# remembers is forgotten at last.
RELAXING = [((), 1e-6), (((1.5, 0.02), (1.0, 0.06)), 2e-3)]


@pytest.fixture(scope="module", params=["cube", "bar"])
def held_body(request, cube_body):
    if request.param == "cube":
        return cube_body
    mesh = block_mesh((0.1, 0.03, 0.03), (10, 3, 3))
    return baked_body(mesh, np.flatnonzero(mesh.nodes[:, 0] == 0.0), 0.3, 5_000.0)


@pytest.mark.parametrize(("relaxation", "same"), RELAXING, ids=["elastic", "relaxing"])
@pytest.mark.parametrize("tip", TIPS)
def test_at_rest_it_presses_as_without_a_clock(held_body, tip, relaxation, same, eventually):
    body, (tool, depth) = held_body, TIPS[tip]
    made = shape(body, "real")
    made.wait_for(np.zeros(0, dtype=np.int64))
    middle = body.mesh.nodes.mean(axis=0)
    place = nearest_place(body, middle + np.array([0.003, 0.002, 0.1]))
    by = depth * place.axis
    turn = facing(-place.axis, np.eye(3)[0])
    end = place.position + by
    if tool is None:
        linear = touch_at(body, place.triangle, place.alpha, by)
    else:
        end = end - (tool.radius if tip == "sphere" else 0.0) * place.axis
        linear = press_tool(body, tool, Pose(end, turn))
    (touch,) = felt(made, [linear], body.young_modulus).touches
    native = native_body(body, whole=True)
    path = end[None, None] - np.linspace(1.5, 0.0, 100)[:, None, None] * by
    servo = SteppedFingers(native, path[0], Settings(body.young_modulus, relaxation=relaxation))
    if tool is not None:
        servo.set_tool(native_tool(body, native, tool), turn, 0)
    servo.follow(path)
    firming = Firming(servo, body, tool)

    def rests():
        before = servo.snapshot().firmness
        firming.follow(servo.snapshot(), made, body.young_modulus)
        servo.follow(np.tile(end, (TICKS, 1, 1)))
        now = servo.snapshot().firmness
        return not firming.looks and abs(now - before) <= 1e-8 and now != 1.0

    # What still relaxes a little is not looked at anew yet.
    eventually(lambda: all([rests(), rests(), rests()]), "the firmness of the press")
    firming.close()
    force = servo.snapshot().contact_force
    assert abs(np.linalg.norm(touch.force) / np.linalg.norm(linear.force) - 1.0) > 1e-3
    np.testing.assert_allclose(force, touch.force, atol=same * np.abs(touch.force).max())
    made.close()
