"""Ports with nobody, or somebody else, behind them."""

import os
import sys
import threading

import pytest

from palpate.core.servo import link
from palpate.core.servo.socket_port import SocketPort, is_socket
from palpate.simulated.wire.ports import device_port

if sys.platform != "win32":
    import tty


class HostEnd:
    """A host's end of a port, whatever it is; it waits for nothing."""

    def __init__(self, path):
        self._port = SocketPort(path, 0.0) if is_socket(path) else Terminal(path)

    def say(self, data):
        self._port.write(data)

    def hear(self):
        """All that has come; nothing from a port that is gone."""
        try:
            return self._port.read(4096)
        except OSError:
            return b""

    def close(self):
        self._port.close()


class Terminal:
    """A terminal as it is found: pyserial would throw away what waits in it."""

    def __init__(self, path):
        self._descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)

    def write(self, data):
        os.write(self._descriptor, data)

    def read(self, size):
        return os.read(self._descriptor, size)

    def close(self):
        os.close(self._descriptor)


@pytest.fixture
def terminal():
    """A pseudo-terminal with nobody behind it: (device's end, path of the host's end)."""
    if sys.platform == "win32":
        pytest.skip("about terminals, which Windows does not have")
    device_end, host_end = os.openpty()
    tty.setraw(host_end)
    yield device_end, os.ttyname(host_end)
    os.close(device_end)
    os.close(host_end)


@pytest.fixture
def silent_port():
    """The path of a port with nobody behind it."""
    port = device_port("")
    yield port.path
    port.unplug()


@pytest.fixture
def foreign_device():
    """The path of a device that answers whatever it hears in protocol 3."""
    port = device_port("")
    answer = link.frame(b"\x01\x03 of a later time")
    over = threading.Event()

    def speak():
        while not over.wait(0.005):
            if port.read(0.0):
                port.write(answer)

    thread = threading.Thread(target=speak)
    thread.start()
    yield port.path
    over.set()
    thread.join()
    port.unplug()
