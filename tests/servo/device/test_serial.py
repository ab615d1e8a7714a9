"""The servo with a device on a pseudo-terminal; the device is written here, from the design."""

import contextlib
import fcntl
import os
import struct
import sys
import threading
import time
import tty

import numpy as np
import pytest
from palpate_servo import STATES, LinkDevice, Servo

from palpate.core.servo.settings import Settings

pytestmark = pytest.mark.skipif(not hasattr(os, "openpty"), reason="needs pseudo-terminals")

ABOVE = (0.02, 0.03, 0.055)
PRESSED = (0.02, 0.03, 0.047)
MODULUS = 10_000.0


def crc16(data):
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ (0x1021 if crc & 0x8000 else 0)) & 0xFFFF
    return crc


def to_frame(payload):
    data = payload + struct.pack("<H", crc16(payload))
    return b"".join(bytes([len(p) + 1]) + p for p in data.split(b"\0")) + b"\0"


def from_frame(frame):
    data = b""
    while frame:
        code, frame = frame[0], frame[1:]
        data += frame[: code - 1] + b"\0"
        frame = frame[code - 1 :]
    data = data[:-1]
    assert crc16(data[:-2]) == struct.unpack("<H", data[-2:])[0]
    return data[:-2]


class FakeDevice:
    """Answers HELLO, streams STATE at about 500 Hz, keeps every FORCE."""

    def __init__(self, folder, protocol=1, max_force=2.5):
        self.path = folder / "port"
        self.protocol, self.max_force = protocol, max_force
        self.position, self.buttons, self.flags = ABOVE, 0, 1
        self.muted = False
        self.insert = b""
        self.forces = []
        self.hellos = 0
        self.sequence = 65_500
        self.greeted = False
        self.plug()

    def plug(self):
        self.master, slave = os.openpty()
        tty.setraw(slave)
        self.path.unlink(missing_ok=True)
        self.path.symlink_to(os.ttyname(slave))
        os.close(slave)
        os.set_blocking(self.master, False)
        self.greeted, self.unread = False, b""
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self._run)
        self.thread.start()

    def unplug(self):
        self.ended.set()
        self.thread.join()
        os.close(self.master)
        self.path.unlink()

    def _run(self):
        while not self.ended.wait(0.002):
            # Nothing there, or nobody has the other end open.
            with contextlib.suppress(OSError):
                self.unread += os.read(self.master, 4096)
            *frames, self.unread = self.unread.split(b"\0")
            for frame in filter(None, frames):
                self._hear(from_frame(frame))
            if self.greeted and not self.muted:
                self._stream()

    def _hear(self, payload):
        if payload == b"\x01\x01":
            self.hellos += 1
            self.greeted = True
            hello = struct.pack(
                "<BB16sBf3fH", 1, self.protocol, b"fake", 3, self.max_force, 0.1, 0.1, 0.1, 500
            )
            self._write(to_frame(hello))
        else:
            kind, _, x, y, z, flags = struct.unpack("<BH3hB", payload)
            assert kind == 3
            self.forces.append((x * 1e-3, y * 1e-3, z * 1e-3, flags))

    def _stream(self):
        # Writing lets other threads run: what is put in meanwhile stays for the next time.
        inserted, self.insert = self.insert, b""
        self._write(inserted)
        self.sequence = (self.sequence + 1) & 0xFFFF
        micrometres = [round(x * 1e6) for x in self.position]
        now = time.monotonic_ns() // 1000 & 0xFFFF_FFFF
        self._write(
            to_frame(
                struct.pack(
                    "<BHI3iBB", 2, self.sequence, now, *micrometres, self.buttons, self.flags
                )
            )
        )

    def _write(self, data):
        with contextlib.suppress(BlockingIOError):
            os.write(self.master, data)

    def glide(self, goal, seconds=0.1):
        start = np.array(self.position)
        for part in np.linspace(0, 1, 30):
            self.position = tuple(start + part * (np.array(goal) - start))
            time.sleep(seconds / 30)


@pytest.fixture
def device(tmp_path):
    device = FakeDevice(tmp_path)
    yield device
    if not device.ended.is_set():
        device.unplug()


@pytest.fixture
def servo(cube):
    with Servo(cube.native, Settings(MODULUS), ramp_seconds=0.05) as servo:
        yield servo


def state_is(servo, state):
    return lambda: servo.snapshot().state == state


def press(device, servo, eventually):
    eventually(state_is(servo, "free"), servo.snapshot)
    device.glide(PRESSED)
    eventually(
        lambda: servo.snapshot().state == "touching" and servo.snapshot().output_force.any(),
        servo.snapshot,
    )


def test_a_press_is_felt_and_what_is_computed_is_sent(device, servo, eventually):
    servo.start(LinkDevice(str(device.path)))
    press(device, servo, eventually)
    eventually(
        lambda: np.allclose(servo.snapshot().output_force, servo.snapshot().contact_force),
        servo.snapshot,
    )
    force = servo.snapshot().output_force
    device.forces.clear()
    eventually(lambda: len(device.forces) > 5)
    np.testing.assert_allclose(device.forces[-1][:3], force, atol=0.6e-3)
    assert device.forces[-1][3] == 1
    link = servo.counters()["link"]
    assert link["device"]["name"] == "fake"
    assert link["device"]["max_force"] == 2.5
    assert link["lost"] == link["crc_errors"] == link["cobs_errors"] == link["unknown"] == 0


def test_stopping_while_pressing_leaves_zero_force_without_enable(device, servo, eventually):
    servo.start(LinkDevice(str(device.path)))
    press(device, servo, eventually)
    servo.stop()
    eventually(lambda: device.forces[-1] == (0, 0, 0, 0), lambda: device.forces[-5:])


def test_the_devices_own_limit_clamps(cube, tmp_path, eventually):
    device = FakeDevice(tmp_path, max_force=0.05)
    try:
        with Servo(cube.native, Settings(MODULUS)) as servo:
            servo.start(LinkDevice(str(device.path)))
            press(device, servo, eventually)
            device.glide(ABOVE)
            strengths = np.linalg.norm(servo.samples()["output"], axis=1)
        assert 0.01 < strengths.max() <= 0.05 * (1 + 1e-6)
    finally:
        device.unplug()


def test_silence_is_stale_and_the_force_ramps_on_return(device, servo, eventually):
    servo.start(LinkDevice(str(device.path)))
    press(device, servo, eventually)
    device.muted = True
    eventually(state_is(servo, "fault"), servo.snapshot)
    shot = servo.snapshot()
    assert shot.fault == "stale"
    assert not shot.output_force.any()
    servo.samples()
    device.muted = False
    eventually(state_is(servo, "touching"), servo.snapshot)
    eventually(lambda: np.allclose(servo.snapshot().output_force, servo.snapshot().contact_force))
    samples = servo.samples()
    assert not samples["output"][samples["state"] == STATES.index("fault")].any()
    ramping = samples[samples["state"] == STATES.index("ramping")]
    gain = np.linalg.norm(ramping["output"], axis=1) / np.linalg.norm(ramping["force"], axis=1)
    assert gain[0] < 0.03
    assert servo.counters()["faults"]["stale"] >= 1


def test_unplugged_while_pressing_and_plugged_in_again(device, servo, eventually):
    servo.start(LinkDevice(str(device.path)))
    press(device, servo, eventually)
    device.unplug()
    eventually(state_is(servo, "fault"), servo.snapshot)
    shot = servo.snapshot()
    assert shot.fault == "unplugged"
    assert not shot.output_force.any()
    device.position = ABOVE
    device.plug()
    press(device, servo, eventually)
    assert servo.counters()["link"]["reopened"] == 1
    assert servo.counters()["faults"]["unplugged"] == 1


def test_the_button_silences_at_once(device, servo, eventually):
    servo.start(LinkDevice(str(device.path)))
    press(device, servo, eventually)
    device.buttons = 1
    eventually(state_is(servo, "disabled"), servo.snapshot)
    shot = servo.snapshot()
    assert (shot.reason, shot.buttons) == ("device button", 1)
    assert not shot.output_force.any()
    device.forces.clear()
    eventually(lambda: len(device.forces) > 5)
    assert device.forces[-1] == (0, 0, 0, 0)


def test_a_jump_is_too_fast_and_silences(device, servo, eventually):
    servo.start(LinkDevice(str(device.path)))
    press(device, servo, eventually)
    device.position = (0.02, 0.03, -0.2)
    eventually(lambda: servo.counters()["faults"]["too fast"] >= 1, servo.snapshot)
    samples = servo.samples()
    faulty = samples["state"] == STATES.index("fault")
    assert faulty.any()
    assert not samples["output"][faulty].any()


def test_a_device_with_a_fault_or_not_ready_gets_no_force(device, servo, eventually):
    servo.start(LinkDevice(str(device.path)))
    press(device, servo, eventually)
    for flags, state in ((3, "fault"), (0, "waiting"), (1, "touching")):
        device.flags = flags
        eventually(state_is(servo, state), servo.snapshot)
        assert servo.snapshot().fault == ("device fault" if state == "fault" else "")
        if state != "touching":
            assert not servo.snapshot().output_force.any()


def test_another_protocol_is_a_fault(cube, tmp_path, eventually):
    device = FakeDevice(tmp_path, protocol=2)
    try:
        with Servo(cube.native, Settings(MODULUS)) as servo:
            servo.start(LinkDevice(str(device.path)))
            eventually(lambda: servo.snapshot().fault == "wrong protocol", servo.snapshot)
        assert device.forces == []
    finally:
        device.unplug()


def test_noise_on_the_line_is_counted_and_survived(device, servo, eventually):
    servo.start(LinkDevice(str(device.path)))
    press(device, servo, eventually)
    state = bytearray(to_frame(struct.pack("<BHI3iBB", 2, 0, 0, 1, 2, 3, 0, 1)))
    state[-2] ^= 0x20
    device.insert = b"\x09\x01\x00" + b"\x33" * 100 + b"\x00" + bytes(state) + to_frame(b"\x09\x09")
    wanted = {"crc_errors": 1, "cobs_errors": 1, "oversize": 1, "unknown": 1}

    def seen():
        link = servo.counters()["link"]
        return {name: link[name] for name in wanted} == wanted

    eventually(seen, lambda: servo.counters()["link"])
    assert servo.snapshot().state == "touching"


def test_the_device_frame_turns_positions_and_forces(device, servo, eventually):
    turn = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    place = np.array(PRESSED)
    device.position = tuple(turn.T @ np.array(ABOVE) / 2)
    servo.start(LinkDevice(str(device.path), rotation=turn, scale=2.0))
    eventually(state_is(servo, "free"), servo.snapshot)
    device.glide(turn.T @ place / 2)
    eventually(lambda: np.allclose(servo.snapshot().probe, place, atol=2e-6), servo.snapshot)
    eventually(lambda: np.allclose(servo.snapshot().output_force, servo.snapshot().contact_force))
    force = servo.snapshot().output_force
    device.forces.clear()
    eventually(lambda: len(device.forces) > 5)
    np.testing.assert_allclose(device.forces[-1][:3], turn.T @ force, atol=0.6e-3)


def test_a_port_that_is_not_there_is_said_so(servo, tmp_path):
    with pytest.raises(OSError, match="nowhere"):
        servo.start(LinkDevice(str(tmp_path / "nowhere")))
    with pytest.raises(ValueError, match="orthonormal"):
        servo.start(LinkDevice(str(tmp_path / "nowhere"), rotation=np.ones((3, 3))))
    assert not servo.running


@pytest.mark.skipif(sys.platform != "linux", reason="asks the Linux kernel for the mode")
def test_a_stopped_servo_gives_the_terminal_back(servo):
    """Else an ordinary user could not press again while the device keeps its end open."""
    is_exclusive = 0x80045440  # TIOCGEXCL
    master, slave = os.openpty()
    try:
        servo.start(LinkDevice(os.ttyname(slave)))
        assert fcntl.ioctl(slave, is_exclusive, b"\0\0\0\0") == b"\1\0\0\0"
        servo.stop()
        assert fcntl.ioctl(slave, is_exclusive, b"\0\0\0\0") == b"\0\0\0\0"
    finally:
        os.close(master)
        os.close(slave)
