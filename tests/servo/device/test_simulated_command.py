"""`palpate servo` against devices that behave, misbehave or are not there."""

import errno
import json
import os
import signal
import subprocess
import sys
from contextlib import contextmanager

import numpy as np
import pytest

from palpate.cli.main import main
from palpate.cli.press import servo as servo_command
from palpate.cli.press.from_above import HAND_FORCE, press_from_above
from palpate.cli.press.servo_report import for_people
from palpate.core.record.read_recording import read_recording
from palpate.core.servo import ports
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice

if sys.platform != "win32":
    import fcntl

SIGNALS = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")

ABOVE, DEEP = (0.026, 0.024, 0.06), (0.026, 0.024, 0.044)


@pytest.fixture
def device():
    with SimulatedDevice(SimulatedOptions(rest=ABOVE)) as device:
        yield device


@contextmanager
def host(baked_file, port):
    """The command as a process of its own, which does not outlive the test."""
    command = [sys.executable, "-m", "palpate.cli.main", "servo", baked_file, "--json"]
    command += ["--port", port, "--seconds", "60"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def held_alone(port):
    """Whether an ordinary user could not open the port now (the superuser always can)."""
    try:
        descriptor = os.open(port, os.O_RDWR | os.O_NOCTTY)
    except OSError as error:
        if error.errno == errno.EBUSY:
            return True
        raise
    answer = fcntl.ioctl(descriptor, ports._TIOCGEXCL, bytes(4))
    os.close(descriptor)
    return any(answer)


def driven(device):
    return device.report()["felt_force"][2] > 0.2


def refused(capsys, *arguments):
    assert main(["servo", *arguments]) == 2
    out, error = capsys.readouterr()
    assert out == ""
    assert error.startswith("palpate: ")
    assert error.count("\n") == 1
    return error


@pytest.mark.in_time
def test_simulate_presses_from_above_and_reports(baked_file, capsys):
    assert main(["servo", baked_file, "--simulate", "--seconds", "4", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["rate_hz"] == 1000
    assert report["ticks"] > 500
    assert report["late_ticks"] <= report["ticks"]
    assert {"p50", "p99", "max"} <= set(report["lateness_us"])
    assert {f"late_over_{us}_us" for us in (10, 50, 200, 1000)} <= set(report)
    assert set(report["stages_us"]["contact"]) == {"mean", "p99", "max"}
    assert {"states", "forces", "lost", "crc_errors"} <= set(report["link"])
    assert report["link"]["states"] > 500
    assert isinstance(report["realtime"], str)
    assert report["faults"]["unplugged"] == 0
    assert report["interrupted"] is False
    # A tenth of the height is 5 mm; the hand's spring gives way to the body's force.
    assert 3.0 < report["deepest_mm"] < 6.5
    # On the way in, the coupling's damping adds a little to what the body gives.
    assert 0.3 < report["peak_output_force_n"] < 1.1 * report["peak_contact_force_n"] < 2.0
    assert report["simulated_device"]["largest_force"] == pytest.approx(
        report["peak_output_force_n"], abs=2e-3
    )


def test_people_get_the_stages_of_the_tick_as_a_table():
    stages = {name: {"mean": 1.234, "p99": 2.0, "max": 34.5} for name in ("read", "write")}
    text = for_people({"ticks": 7, "stages_us": stages, "faults": {}})
    assert text.splitlines() == [
        "ticks   7",
        "faults  none",
        "tick, us       mean      p99      max",
        "read           1.23     2.00    34.50",
        "write          1.23     2.00    34.50",
    ]


def test_a_firmer_body_is_pressed_with_no_more_force_than_the_hand_has(cube):
    soft = press_from_above(cube, 1_000.0)
    firm = press_from_above(cube, 1e8)
    assert soft.at == firm.at
    assert soft.at[2] == pytest.approx(0.05)
    assert soft.rest[2] > soft.at[2]
    # Along the normal of the flat top, straight down.
    assert soft.by[:2] == pytest.approx((0.0, 0.0))
    assert -0.006 < soft.by[2] < -0.005
    # So firm that nothing but the hand's own spring gives way.
    assert firm.by[2] == pytest.approx(-HAND_FORCE / firm.hand_stiffness, rel=1e-3)


@SIGNALS
def test_ctrl_c_zeroes_the_force_and_still_reports(baked_file, device, eventually):
    with host(baked_file, device.port) as process:
        eventually(lambda: device.report()["forces"] > 100)
        device.move_hand(DEEP, 0.2)
        eventually(lambda: driven(device))
        process.send_signal(signal.SIGINT)
        report = json.loads(process.stdout.read())
        process.wait()
    assert process.returncode == 0
    assert report["interrupted"] is True
    assert report["last_state"] in ("ramping", "touching")
    assert report["peak_output_force_n"] > 0.2
    assert device.report()["felt_force"] == [0.0, 0.0, 0.0]


@SIGNALS
def test_a_killed_host_does_not_keep_the_port_from_the_next_one(baked_file, device, eventually):
    for _ in range(2):
        before = device.report()["forces"]
        with host(baked_file, device.port) as process:
            eventually(lambda before=before: device.report()["forces"] > before + 100)
            assert held_alone(device.port)
            process.kill()
        # The host has locked the terminal, which outlives it; the device lets go of the lock.
        eventually(lambda: not held_alone(device.port))


@SIGNALS
def test_unplugged_for_good_is_reported_and_no_failure(baked_file, device, eventually):
    with host(baked_file, device.port) as process:
        eventually(lambda: device.report()["forces"] > 100)
        device.unplug()
        eventually(lambda: device.report()["limp"])
        process.send_signal(signal.SIGTERM)
        report = json.loads(process.stdout.read())
        process.wait()
    assert process.returncode == 0
    assert report["faults"]["unplugged"] == 1
    assert (report["last_state"], report["last_fault"]) == ("fault", "unplugged")


def test_a_port_that_is_not_there_is_an_error(baked_file, capsys, tmp_path):
    path = str(tmp_path / "port")
    assert f"{path}: there is no such port" in refused(capsys, baked_file, "--port", path)


def test_a_file_is_no_port(baked_file, capsys):
    assert "not a serial port" in refused(capsys, baked_file, "--port", baked_file)


def test_a_port_without_an_answer_is_an_error(baked_file, capsys, monkeypatch, silent_port):
    monkeypatch.setattr(servo_command, "HELLO_SECONDS", 0.5)
    assert "does not answer HELLO" in refused(capsys, baked_file, "--port", silent_port)


def test_a_device_of_another_protocol_is_an_error(baked_file, capsys, foreign_device):
    error = refused(capsys, baked_file, "--port", foreign_device)
    assert "another version of the link" in error


@pytest.mark.parametrize("seconds", ["0", "-1", "nan", "inf"])
def test_a_time_without_sense_is_an_error(baked_file, capsys, seconds):
    assert "--seconds" in refused(capsys, baked_file, "--simulate", "--seconds", seconds)


def test_a_rate_or_material_out_of_range_is_an_error(baked_file, capsys, device):
    assert "100 to 8000" in refused(capsys, baked_file, "--port", device.port, "--rate", "10")
    assert "modulus" in refused(capsys, baked_file, "--simulate", "--young", "-5")


@pytest.mark.in_time
def test_a_press_is_recorded_tick_by_tick(baked_file, capsys, tmp_path):
    path = tmp_path / "press.csv"
    arguments = ["servo", baked_file, "--simulate", "--seconds", "2.5", "--json"]
    assert main([*arguments, "--record", str(path)]) == 0
    out, told = capsys.readouterr()
    assert "recording; takes up to 1 MB of memory" in told
    report = json.loads(out)
    recording = read_recording(path)
    assert report["recording"] == {"file": str(path), "ticks": len(recording.samples), "lost": 0}
    samples = recording.samples
    assert samples["tick"].tolist() == list(range(1, len(samples) + 1))
    assert len(samples) > 500
    strengths = np.linalg.norm(samples["output"], axis=1)
    assert strengths.max() == report["peak_output_force_n"] > 0.1
    names = np.array(recording.states)[samples["state"]]
    assert {"waiting", "free", "touching"} <= set(names)
    # A late tick may let go and ramp again at any moment; a force without a touch is wrong always.
    assert not strengths[np.isin(names, ["waiting", "free"])].any()
    assert strengths[names == "touching"].any()


def test_a_recording_that_cannot_be_is_refused_before_the_press(baked_file, capsys, tmp_path):
    simulate = (baked_file, "--simulate", "--record")
    assert "--seconds" in refused(capsys, *simulate, str(tmp_path / "a.csv"), "--seconds", "3600")
    assert "let the name end" in refused(capsys, *simulate, str(tmp_path / "a.txt"))
    assert "no folder" in refused(capsys, *simulate, str(tmp_path / "nowhere" / "a.npz"))
    assert not list(tmp_path.iterdir())
