"""An adapter that holds STATE back is recognised, explained, and asked to hurry where it can be."""

import errno
import json
import random
import struct
import sys
from pathlib import Path

import pytest

from palpate.cli.main import main
from palpate.core.servo import link, ports
from palpate.core.servo.latency_timer import (
    ask_for_low_latency,
    explain,
    explain_readings,
    latency_timer_ms,
    remedy,
)
from palpate.core.servo.ports import check_port, list_ports
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice
from palpate.simulated.wire.wire_faults import BadWire

if sys.platform != "win32":
    import fcntl
    import termios

LOW_LATENCY = 1 << 13


def readings(period_ms=1.0, latency_timer=0.0, looks_ms=1.0, away=(), jitter_ms=0.0):
    """What a reader sees of a device for a second of virtual time."""
    wire, decoder, made, seen = BadWire(0, 0, 0, 1, latency_timer), link.Decoder(), 0, []
    dice = random.Random(5)  # noqa: S311 - dice for jitter, not secrets
    for look in range(round(1000 / looks_ms)):
        now = (look * looks_ms + dice.uniform(0.0, jitter_ms)) * 1e-3
        while made * period_ms * 1e-3 <= now:
            at = made * period_ms * 1e-3
            # The device's clock wraps on the way.
            state = link.State(made, round(at * 1e6 + 2**32 - 300_000) % 2**32, (1, 2, 3))
            wire.put(link.encode(state), at)
            made += 1
        if not any(begin <= now < end for begin, end in away):
            seen.append((now, [m.device_time_us for m in decoder.feed(wire.take(now))]))
    return seen


def test_the_timer_as_delivered_is_recognised_by_its_62_bursts_a_second():
    told = explain_readings(readings(latency_timer=0.016), "/dev/ttyUSB7")
    assert told.startswith("/dev/ttyUSB7: STATE arrives in bursts, one every 16 ms (62.5 Hz)")
    assert "the device makes one every 1 ms" in told
    assert remedy("/dev/ttyUSB7") in told


@pytest.mark.parametrize(("timer", "told"), [(0.010, "10 ms (100 Hz)"), (0.005, "5 ms (200 Hz)")])
def test_other_timers_are_told_with_their_length(timer, told):
    assert told in explain_readings(readings(latency_timer=timer))


@pytest.mark.parametrize(
    "healthy",
    [
        {},
        {"jitter_ms": 2.5},
        {"latency_timer": 0.001},
        {"latency_timer": 0.002},
        {"period_ms": 16.0},
        {"period_ms": 16.0, "latency_timer": 0.016},
        {"looks_ms": 10.0},
        # The reader itself was held up, again and again.
        {"away": [(i * 0.05 + 0.001, i * 0.05 + 0.045) for i in range(20)]},
    ],
)
def test_nothing_else_is_taken_for_it(healthy):
    assert explain_readings(readings(**healthy)) is None


def test_a_device_that_makes_its_states_in_bursts_is_not_held_back_by_the_wire():
    seen = []
    for begin in range(0, 1_000_000, 16_000):
        seen.append((begin * 1e-6, [begin - 900 + 100 * i for i in range(5)]))
        seen += [((begin + 1000 * i) * 1e-6, []) for i in range(1, 16)]
    assert explain_readings(seen) is None


def test_a_few_bursts_are_an_accident():
    assert explain_readings(readings(latency_timer=0.016)[:150]) is None
    assert explain_readings([]) is None


def counters(**changes):
    interval = {"mean": 16_000.0, "max": 17_000.0, "device": 1000.0}
    held = {"states": 1000, "bursts": 62, "burst_ms": 16.0, "burst_states": 990}
    return {**held, "state_interval_us": interval, **changes}


def test_the_servos_counters_are_explained():
    told = explain(counters(), "/dev/ttyUSB0")
    assert "one every 16 ms (62.5 Hz), though the device makes one every 1 ms" in told
    assert "STATE arrives" in explain(counters())
    assert "\n" not in told
    for healthy in ({"bursts": 9}, {"burst_states": 499}, {"bursts": 0, "burst_states": 0}):
        assert explain(counters(**healthy)) is None


@pytest.mark.parametrize(
    ("system", "words"),
    [
        ("win32", "Device Manager"),
        ("darwin", "LatencyTimer"),
        ("linux", "/sys/bus/usb-serial/devices/ttyUSB3/latency_timer"),
    ],
)
def test_the_remedy_is_that_of_the_system(system, words):
    assert words in remedy("/dev/ttyUSB3", system)


@pytest.fixture
def driver(tmp_path):
    """A folder as FTDI's driver shows it, with an adapter at ttyUSB0."""
    (tmp_path / "ttyUSB0").mkdir()
    (tmp_path / "ttyUSB0" / "latency_timer").write_text("16\n")
    return tmp_path


def test_the_timer_is_read_where_the_driver_tells_it(driver):
    assert latency_timer_ms("/dev/ttyUSB0", driver) == 16
    assert latency_timer_ms("/dev/ttyACM0", driver) is None


def test_the_timer_is_found_by_a_link_to_its_port(driver, link):
    by_id = driver / "usb-FTDI-port0"
    link(by_id, Path("/dev/ttyUSB0"))
    assert latency_timer_ms(str(by_id), driver) == 16


linux = pytest.mark.skipif(sys.platform != "linux", reason="a request of Linux")


@linux
def test_a_port_without_a_timer_is_left_as_it_is(terminal):
    with Path(terminal[1]).open("rb+", buffering=0) as port:
        before = termios.tcgetattr(port)
        assert ask_for_low_latency(port.fileno()) is False
        assert termios.tcgetattr(port) == before


@linux
@pytest.mark.parametrize("refuses", [False, True])
def test_the_flag_is_set_and_all_else_handed_back(monkeypatch, refuses):
    found = list(range(100, 132))
    found[4] = 0x40
    asked = []

    def ioctl(descriptor, request, argument):
        asked.append((descriptor, request))
        if request == termios.TIOCGSERIAL:
            assert len(argument) >= 72  # sizeof(struct serial_struct) in 64 bits
            return struct.pack("32i", *found)
        if refuses:
            raise OSError(errno.EPERM, "not allowed")
        expected = [*found[:4], 0x40 | LOW_LATENCY, *found[5:]]
        assert list(struct.unpack("32i", argument)) == expected
        return argument

    monkeypatch.setattr(fcntl, "ioctl", ioctl)
    assert ask_for_low_latency(7) is not refuses
    assert asked == [(7, termios.TIOCGSERIAL), (7, termios.TIOCSSERIAL)]


def test_whoever_checks_a_port_asks_for_low_latency(terminal, monkeypatch):
    asked = []
    monkeypatch.setattr(ports, "ask_for_low_latency", asked.append)
    check_port(terminal[1])
    assert len(asked) == 1


@pytest.fixture
def held_back():
    with SimulatedDevice(SimulatedOptions(latency_timer=0.016)) as device:
        yield device


@pytest.fixture
def no_other_ports(monkeypatch):
    monkeypatch.setattr(ports, "comports", list)


def test_devices_tells_it_of_a_named_port(held_back, no_other_ports, capsys):
    (port,) = list_ports([held_back.port], 20.0)
    assert port.hello.name == "Simulated"
    assert port.warning.startswith(f"{held_back.port}: STATE arrives in bursts")
    assert main(["devices", "--port", held_back.port, "--json"]) == 0
    assert "bursts" in json.loads(capsys.readouterr().out)["ports"][0]["warning"]
    assert main(["devices", "--port", held_back.port]) == 0
    assert "\n  " + held_back.port in capsys.readouterr().out


def test_devices_has_nothing_to_tell_of_a_healthy_port(no_other_ports):
    with SimulatedDevice(SimulatedOptions()) as device:
        (port,) = list_ports([device.port], 20.0)
    assert port.hello
    assert port.warning == ""
