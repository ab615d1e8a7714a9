"""The native servo and the simulated device, each with its own codec: the loop really closes."""

import ctypes
import sys
import time
from pathlib import Path

import numpy as np
import palpate_servo
import pytest
from palpate_servo import harness

from palpate.core.contact.single_press import touch_nearest
from palpate.core.servo import ports
from palpate.core.servo.session import displacements_of, native_body, servo_on
from palpate.core.servo.settings import Settings
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice

if sys.platform == "linux":
    import fcntl

# Over the middle of the cube's top (50 mm), a little off the mesh's symmetry.
ABOVE = (0.026, 0.024, 0.06)
DEEP = (0.026, 0.024, 0.04)
HAND_STIFFNESS = 500.0
# After 12 ms without a tick the guardian says zero, by numbers that the servo passes over, us.
GUARDED = 10_000.0


@pytest.fixture
def loop(cube, started, eventually):
    """Start a device with a hand that waits above the cube, and a servo that has found it."""

    def start(**options):
        hand = SimulatedOptions(rest=ABOVE, hand_stiffness=HAND_STIFFNESS, **options)
        device = started(SimulatedDevice(hand))
        servo = started(servo_on(native_body(cube), Settings(cube.young_modulus)))
        servo.start(palpate_servo.LinkDevice(device.port))
        eventually(lambda: servo.snapshot().state == "free")
        return device, servo

    return start


@pytest.fixture
def press(press_into):
    return lambda device, servo: press_into(device, servo, ABOVE, DEEP)


def undisturbed(device, servo, settled, eventually):
    """The settled device's report and the servo's snapshot of the same time.

    A machine that is busy elsewhere may hold up either of them for more than 20 ms. Then the device
    is limp for a moment and the hand goes on, so both are asked again after the ramp.
    """

    def at_rest():
        before = servo.counters()["faults"]
        report = settled(device, DEEP)
        snapshot = servo.snapshot()
        is_whole = snapshot.state == "touching" and not snapshot.limited
        if is_whole and servo.counters()["faults"] == before:
            return report, snapshot
        return None

    return eventually(at_rest)


def test_the_felt_force_pushes_the_hand_back_until_both_agree(loop, settled, cube, eventually):
    device, servo = loop()
    servo.set(Settings(cube.young_modulus, enabled=False))
    device.move_hand(DEEP, 0.3)
    alone = settled(device, DEEP)
    assert alone["felt_force"] == [0.0, 0.0, 0.0]
    assert alone["position"] == pytest.approx(DEEP, abs=1e-5)

    servo.set(Settings(cube.young_modulus))
    eventually(lambda: servo.snapshot().state == "touching")
    # Until the ramp is through, what is sent is less than the contact's force.
    eventually(
        lambda: (
            np.allclose(servo.snapshot().output_force, servo.snapshot().contact_force)
            and np.linalg.norm(servo.snapshot().contact_force) > 0.3
        )
    )
    report, snapshot = undisturbed(device, servo, settled, eventually)
    force, hand = np.array(report["felt_force"]), np.array(report["hand_force"])
    assert force[2] > 0.5
    np.testing.assert_allclose(hand, -force, atol=0.01)
    pushed = np.array(report["position"]) - DEEP
    np.testing.assert_allclose(pushed, force / HAND_STIFFNESS, atol=2e-5)
    np.testing.assert_allclose(snapshot.probe, report["position"], atol=1e-5)
    np.testing.assert_allclose(snapshot.output_force, force, atol=0.01)
    # The work of the force so far: the device was pushed back against the hand's spring.
    assert report["work_of_felt_force"] > 0.0


def test_depth_force_and_stiffness_are_those_of_the_body(loop, settled, press, cube, eventually):
    device, servo = loop()
    press(device, servo)
    eventually(lambda: np.allclose(servo.snapshot().output_force, servo.snapshot().contact_force))
    report = settled(device, DEEP)
    probe = np.array(report["position"])
    top = np.array([probe[0], probe[1], 0.05])
    expected = touch_nearest(cube, top, probe - top).force
    assert report["felt_force"][2] == pytest.approx(expected[2], rel=0.02)


def test_softer_material_gives_way_while_the_servo_runs(loop, settled, press, eventually):
    device, servo = loop()
    press(device, servo)
    firm = settled(device, DEEP)
    servo.set(Settings(2_000.0))
    eventually(lambda: device.report()["felt_force"][2] < 0.5 * firm["felt_force"][2])
    soft = settled(device, DEEP)
    assert soft["position"][2] < firm["position"][2] - 2e-4


def uninterrupted(loop, eventually):
    """A device and a servo that has stopped after a thousand forces, and was never held up by a
    machine that is busy elsewhere: else they begin again, four times at most.
    """
    for _ in range(5):
        device, servo = loop()
        eventually(lambda servo=servo: servo.counters()["link"]["forces"] > 1000)
        servo.stop()
        if servo.counters()["longest_gap_us"] < GUARDED:
            break
    return device, servo


@pytest.mark.in_time
def test_a_clean_link_loses_nothing(loop, eventually):
    device, servo = uninterrupted(loop, eventually)
    link, report = servo.counters()["link"], device.stop()
    assert [link[name] for name in ("duplicates", "out_of_order", "unknown", "oversize")] == [0] * 4
    assert (link["crc_errors"], link["cobs_errors"]) == (0, 0)
    # Those that the device itself let fall: a host that is held up does not read.
    assert link["lost"] <= report["states_dropped"]
    assert [report[name] for name in ("duplicates", "out_of_order", "clamped")] == [0] * 3
    assert [report[name] for name in ("crc_errors", "malformed", "unknown")] == [0] * 3
    # What came to a device that was held up itself is too old for it, and a gap before the next.
    assert report["lost"] <= report["refused"]
    assert report["forces"] + report["refused"] == link["forces"]


# The guardian of a servo that is held up says zero, with a number 64 ahead of the last one.
@pytest.mark.in_time
def test_lost_frames_are_counted_at_both_ends(loop, eventually):
    device, servo = loop(loss=0.1)
    eventually(lambda: servo.counters()["link"]["lost"] > 50 and device.report()["lost"] > 50)
    servo.stop()
    link, report = servo.counters()["link"], device.stop()
    assert link["crc_errors"] + link["cobs_errors"] + report["crc_errors"] == 0
    assert link["states"] + link["lost"] <= report["states"]
    assert report["forces"] + report["lost"] <= link["forces"]
    assert link["lost"] + report["lost"] <= report["frames_lost_on_purpose"]


def test_noise_is_caught_at_both_ends_and_never_felt(loop, eventually):
    device, servo = loop(noise=5e-4)
    eventually(
        lambda: servo.counters()["link"]["crc_errors"] > 20 and device.report()["crc_errors"] > 20
    )
    samples = servo.samples()
    servo.stop()
    report = device.stop()
    # Nobody touches anything: a damaged frame that passed would show as a jump or a force.
    seen = samples[samples["state"] == palpate_servo.STATES.index("free")]
    assert len(seen) > 100
    assert np.abs(seen["probe"] - ABOVE).max() < 1e-5
    assert report["largest_force"] == 0.0
    assert report["bits_flipped_on_purpose"] > 40


def test_unplugging_gives_zero_and_a_fault_and_replugging_works(loop, press, eventually):
    device, servo = loop()
    press(device, servo)
    device.unplug()
    snapshot = eventually(lambda: (s := servo.snapshot()).fault == "unplugged" and s)
    assert snapshot.state == "fault"
    assert not np.any(snapshot.output_force)
    assert servo.running
    device.move_hand(ABOVE, 0.1)
    eventually(lambda: device.report()["position"] == pytest.approx(ABOVE, abs=1e-4))
    assert device.report()["felt_force"] == [0.0, 0.0, 0.0]

    device.plug_in()
    eventually(lambda: servo.snapshot().state == "free")
    press(device, servo)
    counters = servo.counters()
    assert counters["faults"]["unplugged"] == 1
    assert counters["link"]["reopened"] == 1


def test_the_devices_button_silences_it_at_once(loop, press, eventually):
    device, servo = loop()
    press(device, servo)
    device.press_buttons(1)
    snapshot = eventually(lambda: (s := servo.snapshot()).buttons == 1 and s)
    assert snapshot.state == "disabled"
    assert not np.any(snapshot.output_force)
    eventually(lambda: device.report()["felt_force"] == [0.0, 0.0, 0.0])
    device.press_buttons(0)
    eventually(lambda: np.linalg.norm(servo.snapshot().output_force) > 0.3)


def test_the_device_is_left_without_force_when_the_servo_stops(loop, press, eventually):
    device, servo = loop()
    press(device, servo)
    servo.stop()
    report = eventually(lambda: (r := device.report())["felt_force"] == [0.0, 0.0, 0.0] and r)
    assert report["largest_force"] > 0.3


@pytest.mark.skipif(sys.platform == "win32", reason="asks the C library to keep the interpreter")
def test_a_press_with_deformation_and_a_busy_interpreter_loses_no_ticks(loop, press, cube):
    """Device presses, the shape follows at 60 Hz, then Python is kept for 2 s without a break.

    What the machine itself does to a native thread is seen beside, by one that only sleeps.
    """
    device, servo = loop()
    press(device, servo)
    keep_interpreter = ctypes.PyDLL(None).usleep  # PyDLL: the interpreter's lock stays held
    bare = harness.BareTimer(1000)
    try:
        before, bare_before = servo.counters(), bare.counters()
        drawn = 0
        for _ in range(60):
            moved = displacements_of(cube, servo.snapshot())
            # None while the simulated device is held up, and its force taken back.
            drawn += moved is not None and np.isfinite(moved).all()
            time.sleep(1 / 60)
        keep_interpreter(1_000_000)
        keep_interpreter(1_000_000)
        after, bare_after = servo.counters(), bare.counters()
    finally:
        bare.stop()

    def lost(end, start):
        return end["missed"] - start["missed"]

    assert drawn > 10
    figures = lost(after, before), lost(bare_after, bare_before)
    # With the lock in the loop, all 2,000 ticks of the busy time would be lost.
    assert figures[0] <= figures[1] + 500, figures
    assert servo.snapshot().touching


def test_a_port_that_is_not_there_is_said_so(cube, tmp_path):
    servo, nowhere = servo_on(native_body(cube), Settings(1.0)), str(tmp_path / "nowhere")
    with pytest.raises(OSError, match="nowhere"):
        servo.start(palpate_servo.LinkDevice(nowhere))
    with pytest.raises(ValueError, match="orthonormal"):
        servo.start(palpate_servo.LinkDevice(nowhere, rotation=np.ones((3, 3))))
    assert not servo.running


@pytest.mark.skipif(sys.platform != "linux", reason="asks the Linux kernel for the mode")
def test_a_stopped_servo_gives_the_terminal_back(cube, terminal):
    """Else an ordinary user could not press again while the device keeps its end open."""
    servo = servo_on(native_body(cube), Settings(1.0))
    with Path(terminal[1]).open("rb+", buffering=0) as port:
        for act, is_exclusive in (
            (lambda: servo.start(palpate_servo.LinkDevice(terminal[1])), 1),
            (servo.stop, 0),
        ):
            act()
            mode = fcntl.ioctl(port, ports._TIOCGEXCL, bytes(4))
            assert mode == bytes([is_exclusive, 0, 0, 0])
