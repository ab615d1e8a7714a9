"""The simulated device as a process: how it starts, what it obeys, and that it always ends."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from palpate.core.errors import PalpateError
from palpate.core.machine import run_module
from palpate.core.servo.port_error import PortError
from palpate.core.servo.ports import say_hello
from palpate.simulated import device_process, simulated_process
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice

PATIENCE = 20.0
posix = pytest.mark.skipif(sys.platform == "win32", reason="about signals and links")


def start(*arguments, **pipes):
    """By the starter's path, as Blender starts it: isolated, from anywhere."""
    return subprocess.Popen(
        [sys.executable, "-I", *run_module.command("simulated.device_process"), *arguments],
        stdout=subprocess.PIPE,
        text=True,
        cwd="/",
        **pipes,
    )


@posix
def test_started_by_its_path_it_says_where_it_is_and_at_the_end_what_it_counted():
    with start() as process:
        where = json.loads(process.stdout.readline())
        assert where["pid"] == process.pid
        assert where["link"] is None
        assert say_hello(where["port"], PATIENCE).name == "Simulated"
        process.send_signal(signal.SIGTERM)
        end = json.loads(process.stdout.read())
    assert process.returncode == 0
    assert end["end"] is True
    assert end["hellos"] >= 1
    assert not Path(where["port"]).exists()


@posix
def test_from_the_command_line_ctrl_c_ends_it(tmp_path):
    command = [sys.executable, "-m", "palpate.cli.main", "devices", "simulate", "--json"]
    port = tmp_path / "port"
    command += ["--link", str(port), "--name", "Mine", "--rest", "-1e-3", "0", "0.02"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        where = json.loads(process.stdout.readline())
        assert where["port"] == str(port)
        assert say_hello(str(port), PATIENCE).name == "Mine"
        process.send_signal(signal.SIGINT)
        end = json.loads(process.stdout.read())
    assert process.returncode == 0
    assert end["position"] == pytest.approx([-0.001, 0.0, 0.02], abs=1e-6)
    assert not port.is_symlink()


def test_options_survive_the_way_through_the_command_line():
    options = SimulatedOptions(
        name="My device", rest=(-5e-05, 1e-9, 0.02), by=(0.0, -1e-3, 0.0), loss=0.25, hold=0.5
    )
    with SimulatedDevice(options) as device:
        assert say_hello(device.port, PATIENCE).name == "My device"
        assert device.report()["target"] == pytest.approx([-5e-05, 1e-9, 0.02], abs=1e-12)


def test_commands_are_obeyed(eventually):
    with SimulatedDevice() as device:
        assert say_hello(device.port, PATIENCE)
        device.unplug()
        eventually(lambda: not device.report()["plugged"])
        with pytest.raises(PortError, match="there is no such port"):
            say_hello(device.port, PATIENCE)
        device.plug_in()
        eventually(lambda: device.report()["plugged"])
        assert say_hello(device.port, PATIENCE)
        device.move_hand((0.01, 0.0, 0.0), 0.01)
        eventually(lambda: abs(device.report()["position"][0] - 0.01) < 1e-6)
    assert device.stop()["unplugged"] == 1


@posix
def test_stopping_leaves_nothing_and_may_be_repeated():
    device = SimulatedDevice()
    folder = Path(device.port).parent
    report = device.stop()
    assert report["end"] is True
    assert device.stop() is report
    assert not device.running
    assert not folder.exists()
    with pytest.raises(PalpateError, match="has ended; start it again"):
        device.unplug()


@posix
def test_it_ends_by_itself_when_its_parent_is_killed(tmp_path, eventually):
    port = tmp_path / "port"
    parent = (
        "import sys, time\n"
        "from palpate.simulated.simulated_process import SimulatedDevice, SimulatedOptions\n"
        "device = SimulatedDevice(SimulatedOptions(link=sys.argv[1]))\n"
        "print(device.pid, flush=True)\n"
        "time.sleep(600)\n"
    )
    command = [sys.executable, "-c", parent, str(port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        process.stdout.readline()
        assert port.is_symlink()
        process.kill()
    eventually(lambda: not port.is_symlink())


@posix
def test_it_outlives_a_ctrl_c_that_is_meant_for_its_parent():
    """In a terminal Ctrl-C goes to the whole process group."""
    with SimulatedDevice() as device:
        assert os.getpgid(device.pid) != os.getpgid(0)


def test_a_start_that_fails_gives_the_reason_in_one_line(tmp_path):
    options = SimulatedOptions(script=str(tmp_path / "missing.csv"))
    with pytest.raises(PalpateError, match=r"has ended: .*missing\.csv: cannot be read") as error:
        SimulatedDevice(options)
    assert "\n" not in str(error.value)


def test_a_python_that_is_not_there_is_named(tmp_path):
    with pytest.raises(PalpateError, match=r"cannot be started: .*no-python: \w+"):
        SimulatedDevice(python=str(tmp_path / "no-python"))


def test_a_device_that_hangs_is_ended_all_the_same(monkeypatch):
    monkeypatch.setattr(simulated_process, "ANSWER_SECONDS", 0.3)
    device = SimulatedDevice()
    psutil.Process(device.pid).suspend()
    with pytest.raises(PalpateError, match="has not answered"):
        device.report()
    assert device.stop() == {}
    assert not device.running


def test_windows_is_not_asked_for_the_parent(monkeypatch):
    def asked():
        pytest.fail("a look at all processes")

    monkeypatch.setattr(os, "getppid", asked)
    with monkeypatch.context() as windows:
        windows.setattr(os, "name", "nt")
        parent = device_process._parent()
    assert parent is None
