"""The native servo and the simulated 2DIY in a process of its own, each with its own code for the
protocol and the arm: what is pressed is what is felt, and nothing that goes wrong leaves a force.
"""

import itertools
import json
import math
import signal
import subprocess
import sys
import time

import numpy as np
import psutil
import pytest
from terminals import HostEnd

from palpate.cli.main import main
from palpate.core.contact.single_press import touch_nearest
from palpate.core.servo.haply_models import DEFAULT_MODEL, haply_model
from palpate.core.servo.session import (
    HaplyDevice,
    device_coupling,
    haply_encoder_step,
    native_body,
    servo_on,
)
from palpate.core.servo.settings import Coupling, Settings
from palpate.simulated.board.haply_firmware import PWM_STEPS, TORQUE_AT_FULL_DUTY
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice

MODEL = haply_model(DEFAULT_MODEL)
TOP = (0.026, 0.024, 0.05)
"""In the middle of the cube's top, a little off the mesh's symmetry: the workspace's middle."""
LEAN = math.radians(30.0)
PLANES = {
    "upright": ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
    "leaning": (
        (1.0, 0.0, 0.0),
        (0.0, math.sin(LEAN), -math.cos(LEAN)),
        (0.0, math.cos(LEAN), math.sin(LEAN)),
    ),
}
FREE = (0.002, 0.012, 0.0)
DEEP = (0.002, -0.012, 0.0)
SHALLOW = (0.002, -0.003, 0.0)
TORQUE_ROUNDING = 0.016
"""What torques lose in bytes that are no commands, at most."""


@pytest.fixture
def loop(cube, started, eventually):
    """Start a 2DIY whose hand waits in the rest pose above the cube, and a servo that has it."""

    def start(plane="upright", **options):
        device = started(SimulatedDevice(SimulatedOptions(**options), haply=DEFAULT_MODEL))
        coupling = Coupling(math.inf, 0.0, passivity_control=False)
        settings = Settings(cube.young_modulus, coupling=coupling)
        servo = started(servo_on(native_body(cube), settings))
        servo.start(HaplyDevice(device.port, rotation=PLANES[plane], translation=TOP))
        eventually(lambda: servo.snapshot().state == "free", servo.snapshot)
        return device, servo

    return start


@pytest.fixture
def press(press_into):
    return lambda device, servo: press_into(device, servo, FREE, DEEP)


def corners(degrees):
    """Arm angles (rad) that the host may take for these: two counts off, by offset and encoder."""
    counts = [2.0 * 360.0 / (resolution / 2.0) for resolution in MODEL.resolutions]
    for signs in itertools.product((-1.0, 0.0, 1.0), repeat=2):
        yield tuple(
            math.radians(angle + sign * count)
            for angle, sign, count in zip(degrees, signs, counts, strict=True)
        )


@pytest.mark.in_time
def test_coarse_encoders_soften_the_coupling_unless_another_was_chosen(
    cube, eventually, press_into
):
    """On a body of some 10,000 N/m, by what is felt at rest for each metre pressed."""
    limit = device_coupling(encoder_step=haply_encoder_step(DEFAULT_MODEL))["stiffness"]
    own = device_coupling()
    for chosen, stiffest in ((None, limit), (own, own["stiffness"])):
        device = SimulatedDevice(SimulatedOptions(coulomb=0.1), haply=DEFAULT_MODEL)
        settings = Settings(1e6, coupling=chosen and Coupling(**chosen))
        with device, servo_on(native_body(cube), settings) as servo:
            servo.start(HaplyDevice(device.port, rotation=PLANES["upright"], translation=TOP))
            eventually(lambda: servo.snapshot().state == "free", servo.snapshot)
            press_into(device, servo, FREE, SHALLOW, felt=0.15)
            felt = eventually(lambda: resting_stiffness(servo), servo.snapshot)
        assert felt == pytest.approx(stiffest, rel=0.3)
        assert felt <= stiffest * 1.001


def resting_stiffness(servo):
    """N/m between proxy and probe, once neither has moved for 20 looks; None before."""
    shot = servo.snapshot()
    for _ in range(20):
        time.sleep(0.003)
        after = servo.snapshot()
        if shot.limited or not np.array_equal(shot.probe, after.probe):
            return None
    return np.linalg.norm(after.output_force) / np.linalg.norm(after.probe - after.proxy)


@pytest.mark.in_time
@pytest.mark.parametrize("plane", PLANES)
def test_the_force_felt_is_that_of_a_press_in_the_plane(loop, cube, plane, press, settled):
    device, servo = loop(plane)
    press(device, servo)
    report = settled(device, DEEP, 1e-7)
    shot = servo.snapshot()
    rotation = np.array(PLANES[plane])
    truth = tuple(math.radians(angle) for angle in report["angles"])

    # The place: what two counts on either arm can move the handle by.
    seen = rotation.T @ (shot.probe - TOP)
    places = [
        MODEL.device_position(MODEL.arm.handle(angles)) for angles in corners(report["angles"])
    ]
    assert seen[2] == pytest.approx(0.0, abs=1e-12)
    farthest = max(math.dist(place, report["position"]) for place in places)
    assert math.dist(seen, report["position"]) <= farthest

    # The force: `palpate press` at that place, the part within the plane.
    touch = touch_nearest(cube, at=shot.proxy, by=shot.probe - shot.proxy)
    assert shot.contact_force == pytest.approx(touch.force, rel=1e-6, abs=1e-9)
    wanted = rotation.T @ touch.force
    if plane == "leaning":
        assert abs(wanted[2]) > 0.1

    # Each torque is off by its rounding and a step of the PWM; and the host computes it for its own
    # angles, up to two counts from the true ones.
    arm = MODEL.arm
    units = [abs(arm.handle_force(truth, unit)) for unit in ((1.0, 0.0), (0.0, 1.0))]
    told = [
        report["torques"][port] * (1.0 if sense == 0 else -1.0)
        for port, sense in zip(MODEL.ports, MODEL.motor_senses, strict=True)
    ]
    by_torques = sum(
        unit * (TORQUE_ROUNDING * abs(torque) + TORQUE_AT_FULL_DUTY / PWM_STEPS)
        for unit, torque in zip(units, told, strict=True)
    )
    meant = arm.handle_force(truth, told)
    by_angles = max(
        abs(arm.handle_force(angles, told) - meant) for angles in corners(report["angles"])
    )
    off = math.dist(report["felt_force"][:2], wanted[:2])
    assert off <= by_torques + by_angles, (report["felt_force"], wanted)
    # The bound says something: it is far from allowing any force.
    assert by_torques + by_angles < 0.12 * np.linalg.norm(wanted[:2])


def test_stopping_leaves_no_torque_and_the_board_keeps_its_angles(loop, press, settled, eventually):
    device, servo = loop()
    press(device, servo)
    before = settled(device, DEEP, 1e-7)["position"]
    servo.stop()
    assert device.report()["torques"] == [0.0, 0.0]
    # The handle is nowhere near its rest pose now; the board still knows.
    servo.start(HaplyDevice(device.port, rotation=PLANES["upright"], translation=TOP))
    eventually(lambda: servo.snapshot().state in {"free", "touching"}, servo.snapshot)
    assert device.report()["setups"] == 1
    here = servo.snapshot().probe - TOP
    assert abs(here[2] - before[1]) < 0.005


def test_a_pulled_plug_is_told_and_ends_in_a_new_start_at_rest(loop, press, eventually):
    device, servo = loop()
    press(device, servo)
    device.unplug()
    eventually(lambda: servo.snapshot().fault == "unplugged", servo.snapshot)
    assert not servo.snapshot().output_force.any()
    device.plug_in()
    eventually(lambda: "put the handle in its rest pose" in servo.snapshot().reason, servo.snapshot)
    assert device.report()["torques"] == [0.0, 0.0]
    device.move_hand(MODEL.rest, 0.2)
    eventually(lambda: math.dist(device.report()["position"], MODEL.rest) < 1e-4)
    servo.stop()
    servo.start(HaplyDevice(device.port, rotation=PLANES["upright"], translation=TOP))
    eventually(lambda: servo.snapshot().state == "free", servo.snapshot)
    press(device, servo)


def test_a_board_that_hangs_is_stale_until_it_goes_on(loop, press, eventually):
    device, servo = loop()
    press(device, servo)
    board = psutil.Process(device.pid)
    board.suspend()
    try:
        eventually(lambda: servo.snapshot().fault == "stale", servo.snapshot)
        assert not servo.snapshot().output_force.any()
    finally:
        board.resume()
    # Where the hand went farther than 4 mm unseen, it is set down inside: out, and in again.
    device.move_hand(MODEL.rest, 0.2)
    eventually(lambda: math.dist(device.report()["position"], MODEL.rest) < 1e-3)
    eventually(lambda: servo.snapshot().state == "free", servo.snapshot)
    press(device, servo)
    eventually(lambda: np.linalg.norm(servo.snapshot().output_force) > 0.3, servo.snapshot)
    assert device.report()["setups"] == 1


def test_a_board_that_is_killed_is_gone(loop, press, eventually):
    device, servo = loop()
    press(device, servo)
    psutil.Process(device.pid).kill()
    eventually(lambda: servo.snapshot().state == "fault", servo.snapshot)
    assert not servo.snapshot().output_force.any()


def test_a_line_that_loses_and_flips_bytes_gives_no_wild_force(loop):
    device, servo = loop(loss=2e-5, noise=2e-5, seed=3)
    device.move_hand(DEEP, 0.3)
    end = time.monotonic() + 1.5
    positions = []
    while time.monotonic() < end:
        positions.append(device.report()["position"])
    link = servo.counters()["link"]
    servo.stop()
    report = device.report()
    assert report["torques"] == [0.0, 0.0]
    assert report["bytes_lost_on_purpose"] + report["bits_flipped_on_purpose"] > 0
    assert link["states"] > 100
    # The hand holds it between the rest pose and the deepest press, whatever arrives.
    assert all(-0.02 < y < MODEL.rest[1] + 0.01 for _, y, _ in positions)


def test_what_makes_no_sense_is_refused_before_any_port_is_opened(cube):
    servo = servo_on(native_body(cube), Settings(cube.young_modulus))
    for wrong, reason in (
        ({"model": "3diy"}, r"3diy.*2diy-3\.1"),
        ({"angles": (400.0, 0.0)}, "from -360 to 360"),
        ({"angles": (math.nan, 0.0)}, "from -360 to 360"),
        ({"baud": 1200}, "1200"),
        ({"scale": 0.0}, "scale"),
    ):
        with pytest.raises(ValueError, match=reason):
            servo.start(HaplyDevice("/nowhere", **wrong))
    with pytest.raises(OSError, match="/nowhere"):
        servo.start(HaplyDevice("/nowhere"))
    assert not servo.running


@pytest.mark.in_time
def test_the_command_touches_with_a_2diy(baked_file, capsys):
    # The command puts the workspace's middle on the middle of the top.
    hand = SimulatedOptions(by=(0.0, -0.075, 0.0), approach=0.2, period=1.0)
    with SimulatedDevice(hand, haply=DEFAULT_MODEL) as device:
        line = ["servo", baked_file, "--haply", device.port, "--seconds", "2.5", "--json"]
        assert main(line) == 0
        assert device.report()["torques"] == [0.0, 0.0]
    report = json.loads(capsys.readouterr().out)
    assert report["link"]["device"]["name"] == "Haply 2DIY 3.1"
    assert report["touching_ticks"] > 50
    assert report["peak_output_force_n"] > 0.3


def test_the_command_names_a_port_where_no_board_answers(baked_file, capsys, monkeypatch):
    monkeypatch.setattr("palpate.cli.press.haply.ANSWER_SECONDS", 0.3)
    with SimulatedDevice() as device:
        assert main(["servo", baked_file, "--haply", device.port]) != 0
    error = capsys.readouterr().err
    assert device.port in error
    assert "no answer from a hAPI board" in error


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
def test_a_2diy_is_simulated_from_the_command_line(eventually):
    command = [sys.executable, "-m", "palpate.cli.main", "devices", "simulate", "--haply", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            port = json.loads(process.stdout.readline())["port"]
            host = HostEnd(port)
            # Nobody's device: the address comes back alone.
            host.say(bytes([2, 77]))
            eventually(lambda: host.hear() == bytes([77]))
            host.close()
            process.send_signal(signal.SIGTERM)
            assert json.loads(process.stdout.readline())["answers"] == 1
        finally:
            process.kill()
