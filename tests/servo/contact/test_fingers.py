"""Several fingers on one body: against the reference of core, and as real devices and pointers."""

import numpy as np
import pytest
from palpate_servo import MAX_FINGERS, STATES, Body, LinkDevice, Pointer, Servo

from palpate.core.contact.single_press import press_points
from palpate.core.contact.tool.tools import sphere
from palpate.core.servo.session import displacements_of, native_body, native_tool
from palpate.core.servo.settings import Settings
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice

MODULUS = 10_000.0
EDGE = 0.05
LEFT, RIGHT = np.array([-0.003, 0.025, 0.025]), np.array([EDGE + 0.003, 0.025, 0.025])


def pinch(servo, depth):
    way = np.array([0.003 + depth, 0, 0])
    servo.set_target(LEFT + way)
    servo.set_target(RIGHT - way, finger=1)


def rests_at(servo, depth):
    def rests():
        left, right = servo.snapshot().fingers
        return (
            np.isclose(left.probe[0], depth)
            and np.isclose(right.probe[0], EDGE - depth)
            and left.state == right.state == "touching"
        )

    return rests


@pytest.fixture
def pinched(whole, eventually):
    with Servo(whole, Settings(MODULUS)) as servo:
        assert servo.add(Pointer(RIGHT)) == 1
        servo.start(Pointer(LEFT))
        pinch(servo, 0.004)
        eventually(rests_at(servo, 0.004))
        yield servo


def test_two_pointers_press_as_the_reference_says(cube_body, pinched):
    fingers = pinched.snapshot().fingers
    touches = press_points(
        cube_body,
        [finger.proxy for finger in fingers],
        [finger.probe - finger.proxy for finger in fingers],
    )
    for finger, touch in zip(fingers, touches, strict=True):
        scale = np.abs(touch.force).max()
        np.testing.assert_allclose(finger.contact_force, touch.force, atol=1e-6 * scale)
        np.testing.assert_allclose(finger.surface_point, finger.probe, atol=1e-9)
    assert fingers[0].contact_force[0] < -0.01
    assert fingers[1].contact_force[0] > 0.01


def test_displacements_are_those_of_all_fingers(cube_body, pinched):
    snapshot = pinched.snapshot()
    moved = displacements_of(cube_body, snapshot)
    for finger in snapshot.fingers:
        free = cube_body.free_index(cube_body.mesh.surface_nodes[finger.triangle])
        np.testing.assert_allclose(
            finger.alpha @ moved[free], finger.probe - finger.proxy, atol=2e-6
        )


def test_the_recording_tells_fingers_apart(pinched, eventually):
    pinched.samples()
    tick = pinched.snapshot().tick
    eventually(lambda: pinched.snapshot().tick > tick + 20)
    pinched.stop()
    samples = pinched.samples()
    samples = samples[: len(samples) // 2 * 2]
    np.testing.assert_array_equal(samples["finger"][::2], 1 - samples["finger"][1::2])
    np.testing.assert_array_equal(samples["tick"][::2], samples["tick"][1::2])


def test_switching_off_silences_every_finger(pinched, eventually):
    pinched.set(Settings(MODULUS, enabled=False))
    eventually(lambda: all(f.state == "disabled" for f in pinched.snapshot().fingers))
    assert not any(finger.output_force.any() for finger in pinched.snapshot().fingers)


def test_another_body_must_be_a_whole_one(cube_body, whole, pinched):
    with pytest.raises(ValueError, match="whole=True"):
        pinched.set_body(native_body(cube_body), Settings(MODULUS))
    pinched.set_body(whole, Settings(MODULUS))


def test_fingers_are_refused_with_the_reason(cube_body, whole, cube):
    assert isinstance(cube.native, Body)
    with pytest.raises(ValueError, match="whole=True"):
        Servo(cube.native, Settings(MODULUS)).add(Pointer(LEFT))
    servo = Servo(whole, Settings(MODULUS))
    for number in range(1, MAX_FINGERS):
        assert servo.add(Pointer(RIGHT)) == number
    with pytest.raises(ValueError, match=f"at most {MAX_FINGERS} fingers"):
        servo.add(Pointer(RIGHT))
    with pytest.raises(OSError, match="cannot be opened"):
        Servo(whole, Settings(MODULUS)).add(LinkDevice("/dev/nobody"))
    with pytest.raises(RuntimeError, match="finger 3 is none"):
        Servo(whole, Settings(MODULUS)).set_target(LEFT, finger=3)
    with pytest.raises(ValueError, match="no rotation"):
        servo.set(Settings(MODULUS, orientations=[2 * np.eye(3)]))
    with pytest.raises(ValueError, match="fingers 0 to"):
        servo.set(Settings(MODULUS, orientations=[np.eye(3)] * (MAX_FINGERS + 1)))
    with servo:
        servo.start(Pointer(LEFT))
        assert servo.finger_count == MAX_FINGERS
        with pytest.raises(RuntimeError, match="runs already"):
            servo.add(Pointer(RIGHT))
    assert servo.finger_count == 1


def test_modes_are_refused_by_name(whole):
    with pytest.raises(ValueError, match="paper"):
        Servo(whole, Settings(MODULUS, mode="exact"))
    servo = Servo(whole, Settings(MODULUS))
    servo.set(Settings(MODULUS, mode="paper"))
    with pytest.raises(ValueError, match="consistent"):
        servo.set(Settings(MODULUS, mode=""))


def test_a_tool_is_felt_and_shown_and_taken_off_again(cube_body, whole, eventually):
    tool = native_tool(cube_body, whole, sphere(0.008))
    above = np.array([0.025, 0.025, EDGE + 0.01])
    with Servo(whole, Settings(MODULUS)) as servo:
        servo.set_tool(tool)
        servo.start(Pointer(above))
        servo.set_target(above - [0, 0, 0.005])
        eventually(lambda: np.isclose(servo.snapshot().probe[2], above[2] - 0.005))
        eventually(lambda: servo.snapshot().fingers[0].state == "touching")
        finger = servo.snapshot().fingers[0]
        assert len(finger.points) == len(finger.point_forces) == len(finger.pressures) > 0
        assert (finger.pressures > 0).all()
        for forces in (finger.point_forces, finger.nodal_forces):
            np.testing.assert_allclose(-forces.sum(axis=0), finger.contact_force, atol=1e-9)
        distance = np.linalg.norm(finger.points - finger.proxy, axis=1)
        np.testing.assert_allclose(distance, 0.008, atol=1e-6)
        moved = displacements_of(cube_body, servo.snapshot())
        assert moved is not None
        assert moved[:, 2].min() < -0.001
        servo.set_tool(None)
        servo.set_target(above, restart=True)
        eventually(lambda: not servo.snapshot().touching)
        servo.set_target([0.025, 0.025, EDGE - 0.002])
        eventually(lambda: servo.snapshot().triangle_index >= 0)
    with pytest.raises(ValueError, match="another body"):
        Servo(native_body(cube_body, whole=True), Settings(MODULUS)).set_tool(tool)


def hand(way, side):
    """Presses 4 mm in from a side at x = ``side``, along ``way``."""
    return SimulatedOptions(
        rest=(side - 0.01 * way, 0.025, 0.025),
        at=(side, 0.025, 0.025),
        by=(0.004 * way, 0.0, 0.0),
        approach=0.5,
        period=2.0,
    )


def test_two_devices_on_pseudo_terminals_press_one_body_and_feel_each_other(
    cube_body, whole, eventually
):
    left, right = hand(1.0, 0.0), hand(-1.0, EDGE)
    with (
        SimulatedDevice(left) as one,
        SimulatedDevice(right) as two,
        Servo(whole, Settings(MODULUS)) as servo,
    ):
        assert servo.add(LinkDevice(two.port)) == 1
        servo.start(LinkDevice(one.port))
        eventually(lambda: all(f.touching for f in servo.snapshot().fingers))
        eventually(lambda: all(f["link"]["forces"] > 100 for f in servo.counters()["fingers"]))
        eventually(lambda: any_both_press(servo.samples()))
        counters = servo.counters()["fingers"]
        assert [f["link"]["device"] is not None for f in counters] == [True, True]
        two.stop()
        eventually(lambda: servo.snapshot().fingers[1].state == "fault")
        eventually(lambda: servo.snapshot().fingers[0].touching)
        first, second = servo.snapshot().fingers
        assert first.fault == ""
        assert not second.output_force.any()


def any_both_press(samples):
    touching = samples["state"] == STATES.index("touching")
    pushed = np.linalg.norm(samples["output"], axis=1) > 0.01
    ticks = [set(samples["tick"][touching & pushed & (samples["finger"] == n)]) for n in (0, 1)]
    return bool(ticks[0] & ticks[1])
