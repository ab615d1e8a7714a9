"""The loop over a socket of this computer, which is what simulated devices have on Windows."""

import subprocess
import sys

import numpy as np
import palpate_servo
import pytest

from palpate.core.errors import PalpateError
from palpate.core.servo.ports import check_port, list_ports, say_hello
from palpate.core.servo.session import native_body, servo_on
from palpate.core.servo.settings import Settings
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice
from palpate.simulated.wire.ports import ANY_SOCKET

ABOVE = (0.026, 0.024, 0.06)
DEEP = (0.026, 0.024, 0.04)


@pytest.fixture
def device(started):
    return started(SimulatedDevice(SimulatedOptions(rest=ABOVE, link=ANY_SOCKET)))


@pytest.fixture
def servo(cube, device, started, eventually):
    servo = started(servo_on(native_body(cube), Settings(cube.young_modulus)))
    servo.start(palpate_servo.LinkDevice(device.port))
    eventually(lambda: servo.snapshot().state == "free")
    return servo


def test_a_press_is_felt_and_let_go(device, servo, press_into, eventually):
    press_into(device, servo, ABOVE, DEEP)
    eventually(lambda: device.report()["felt_force"][2] > 0.5)
    servo.stop()
    eventually(lambda: device.report()["felt_force"] == [0.0, 0.0, 0.0])
    assert servo.counters()["link"]["crc_errors"] == 0


def test_a_plug_that_is_pulled_comes_back_at_its_port(device, servo, eventually):
    path = device.port
    device.unplug()
    eventually(lambda: servo.snapshot().fault == "unplugged")
    device.plug_in()
    eventually(lambda: servo.snapshot().state == "free")
    assert servo.counters()["link"]["reopened"] == 1
    assert device.port == path


def test_ports_are_asked_by_name_and_a_second_host_is_told(device, servo):
    (port,) = (one for one in list_ports([device.port]) if one.path == device.port)
    assert "in use by another program" in port.reason
    servo.stop()
    assert say_hello(device.port).name == "Simulated"
    check_port(device.port)
    device.unplug()
    (port,) = (one for one in list_ports([device.port]) if one.path == device.port)
    assert "there is no such port" in port.reason


def test_another_computers_socket_is_refused():
    with pytest.raises(PalpateError, match="no socket of this computer"):
        check_port("socket://192.0.2.1:4000")


HOST = """
import sys, time
import palpate_servo
from palpate.core.body import body_file
from palpate.core.servo.session import native_body, servo_on
from palpate.core.servo.settings import Settings
body = body_file.load(sys.argv[1])
servo = servo_on(native_body(body), Settings(body.young_modulus))
servo.start(palpate_servo.LinkDevice(sys.argv[2]))
time.sleep(600)
"""


def test_a_killed_host_leaves_no_force(device, baked_file, eventually):
    with subprocess.Popen([sys.executable, "-c", HOST, baked_file, device.port]) as host:
        eventually(lambda: device.report()["hellos"] > 0)
        device.move_hand(DEEP, 0.3)
        eventually(lambda: np.linalg.norm(device.report()["felt_force"]) > 0.3)
        host.kill()
        host.wait()
        eventually(lambda: device.report()["felt_force"] == [0.0, 0.0, 0.0])
