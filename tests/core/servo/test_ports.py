"""Ports are listed with what answers there, or with the reason why nothing does."""

import dataclasses
import errno
import json
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
import serial

from palpate.cli.main import main
from palpate.core.servo import ports
from palpate.core.servo.port_error import PortError
from palpate.core.servo.ports import check_port, list_ports, say_hello
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice

if sys.platform != "win32":
    import fcntl
    import termios


@pytest.fixture(autouse=True)
def no_port_of_this_machine_is_spoken_to(monkeypatch):
    monkeypatch.setattr(ports, "comports", list)


@pytest.fixture(scope="module")
def device():
    with SimulatedDevice(SimulatedOptions(name="Test", largest_force=2.0)) as device:
        yield device


def fake(path, **known):
    nothing = {"description": "n/a", "manufacturer": None, "product": None, "vid": None}
    return SimpleNamespace(device=path, **{**nothing, "pid": None, **known})


def test_a_device_answers_hello_as_often_as_it_is_asked(device):
    for _ in range(2):
        assert say_hello(device.port, 20.0) == dataclasses.replace(
            device.options.hello, half_extents=pytest.approx((0.1, 0.1, 0.1))
        )


def test_named_ports_are_asked_and_the_reasons_stand_beside_them(device, tmp_path, silent_port):
    nowhere, file = tmp_path / "nowhere", tmp_path / "file"
    file.touch()
    asked = list_ports([device.port, str(nowhere), str(file), silent_port, device.port], 3.0)
    assert [port.path for port in asked] == [device.port, str(nowhere), str(file), silent_port]
    assert asked[0].hello.name == "Test"
    assert [port.hello for port in asked[1:]] == [None] * 3
    for port, reason in zip(
        asked, ["", "no such port", "not a serial port", "does not answer HELLO"], strict=True
    ):
        assert reason in port.reason
        assert bool(port.reason) == (port.hello is None)


def test_only_usb_devices_are_asked_without_being_named(device, monkeypatch, silent_port):
    usb = fake(device.port, manufacturer="Maker", product="Thing", vid=0x16C0, pid=0x483)
    monkeypatch.setattr(ports, "comports", lambda: [usb, fake(silent_port)])
    first, second = list_ports(seconds=20.0)
    assert (first.vendor, first.product, first.usb_id) == ("Maker", "Thing", "16c0:0483")
    assert first.hello.name == "Test"
    assert second.reason.startswith("not asked")
    assert (second.description, second.vendor, second.product, second.usb_id) == ("",) * 4


def test_what_may_be_a_2diy_is_asked_only_when_it_is_named(device, monkeypatch):
    zero = fake(device.port, vid=0x2341, pid=0x804D)
    monkeypatch.setattr(ports, "comports", lambda: [zero])
    (left_alone,) = list_ports(seconds=20.0)
    assert left_alone.hello is None
    assert f"--haply {device.port}" in left_alone.reason
    (asked,) = list_ports([device.port], 20.0)
    assert asked.hello.name == "Test"


def test_a_device_of_another_protocol_is_refused_with_both_versions(foreign_device):
    with pytest.raises(PortError, match=r"speaks version 3 .* speaks version 2"):
        say_hello(foreign_device, 20.0)


def test_a_port_that_another_program_holds_is_left_alone(terminal):
    with Path(terminal[1]).open("rb+", buffering=0) as holder:
        fcntl.ioctl(holder, termios.TIOCEXCL)
        with pytest.raises(PortError, match="in use by another program"):
            say_hello(terminal[1], 1.0)
    os.set_blocking(terminal[0], False)
    with pytest.raises(BlockingIOError):
        os.read(terminal[0], 1)


def test_a_port_that_pyserial_holds_is_in_use(terminal, monkeypatch):
    with Path(terminal[1]).open("rb+", buffering=0) as holder:
        fcntl.flock(holder, fcntl.LOCK_EX)
        with pytest.raises(PortError, match="in use by another program"):
            say_hello(terminal[1], 5.0)


@pytest.mark.skipif(sys.platform == "win32", reason="ports have no rights there")
def test_a_port_without_permission_is_reported_with_the_remedy(monkeypatch):
    def refuse(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(ports.os, "open", refuse)
    with pytest.raises(PortError, match=r"ttyACM0: no permission .* dialout"):
        check_port("/dev/ttyACM0")


def test_command_prints_one_line_a_port(device, capsys):
    assert main(["devices", "--port", device.port, "/nowhere/at/all"]) == 0
    first, second = capsys.readouterr().out.splitlines()
    told = f"{device.port}  Test: 3 axes, 2 N, 1000 Hz, round trip "
    assert first.startswith(told)
    assert float(first.removeprefix(told).removesuffix(" ms")) > 0.0
    assert "no such port" in second


def test_a_port_without_a_name_is_shown_as_such(capsys):
    assert main(["devices", "--port", ""]) == 0
    assert "''  there is no such port" in capsys.readouterr().out
    assert main(["devices", "attack", ""]) == 2
    said = capsys.readouterr().err
    assert "'': there is no such port; plug the device in" in said
    assert "will push" not in said


def test_a_device_that_turns_its_stylus_is_told_as_such(capsys):
    with SimulatedDevice(SimulatedOptions(name="Test", turning=0.0)) as turning:
        assert main(["devices", "--port", turning.port]) == 0
        line = capsys.readouterr().out.strip()
        told = f"{turning.port}  Test: 3 axes, 3 N, 1000 Hz, tells its orientation, round trip "
        assert line.startswith(told)
        (port,) = list_ports([turning.port])
        assert port.tells_orientation
        assert not port.warning


def test_command_prints_json(device, capsys):
    assert main(["devices", "--json", "--port", device.port]) == 0
    (port,) = json.loads(capsys.readouterr().out)["ports"]
    assert port["path"] == device.port
    assert port["hello"]["largest_force"] == 2.0
    assert port["reason"] == ""
    assert port["tells_orientation"] is False


def test_command_says_what_to_do_when_there_is_nothing(capsys):
    assert main(["devices"]) == 0
    assert "palpate devices simulate" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("said", "reason"),
    [
        (
            "FileNotFoundError(2, 'Die Datei wurde nicht gefunden', None, 2)",
            "no such port",
        ),
        ("PermissionError(13, 'Zugriff verweigert', None, 5)", "in use by another program"),
    ],
)
def test_a_com_port_that_is_missing_or_taken_is_told_in_any_language(monkeypatch, said, reason):

    def refuse(path, *_, **__):
        raise serial.SerialException(f"could not open port {path!r}: {said}")

    monkeypatch.setattr(ports.sys, "platform", "win32")
    monkeypatch.setattr(ports.serial, "Serial", refuse)
    with pytest.raises(PortError, match=f"COM7: .*{reason}"):
        say_hello("COM7")


@pytest.mark.parametrize(
    ("number", "reason"),
    [
        (errno.ENOENT, "no such port"),
        (errno.EINVAL, "no such port"),
        (errno.EACCES, "in use by another program"),
    ],
)
def test_a_com_port_is_checked_by_opening_it_once(monkeypatch, number, reason):
    asked = []

    def refuse(path, _flags):
        asked.append(path)
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(ports.sys, "platform", "win32")
    monkeypatch.setattr(ports.os, "open", refuse)
    with pytest.raises(PortError, match=f"COM12: .*{reason}"):
        check_port("COM12")
    assert asked == [r"\\.\COM12"]


@pytest.mark.skipif(sys.platform != "win32", reason="about what Windows itself says of a port")
@pytest.mark.parametrize("asked", [check_port, say_hello])
def test_a_com_port_that_is_not_there_is_told_as_such(asked):
    with pytest.raises(PortError, match=r"COM199: .*no such port"):
        asked("COM199")
