"""Waiting for things that happen in their own time."""

import os
import threading
import time
import tty

import pytest

from palpate.core.devices import link


@pytest.fixture
def eventually():
    """Wait until a condition holds; its last value is returned, or the test fails."""

    def wait(condition, seconds=20.0):
        deadline = time.monotonic() + seconds
        while not (value := condition()):
            assert time.monotonic() < deadline, "this did not happen"
            time.sleep(0.005)
        return value

    return wait


@pytest.fixture
def terminal():
    """A pseudo-terminal with nobody behind it: (device's end, path of the host's end)."""
    device_end, host_end = os.openpty()
    tty.setraw(host_end)
    yield device_end, os.ttyname(host_end)
    os.close(device_end)
    os.close(host_end)


@pytest.fixture
def foreign_device(terminal):
    """The path of a device that answers whatever it hears in protocol 2."""
    device_end, path = terminal
    answer = link.frame(b"\x01\x02 of a later time")
    over = threading.Event()

    def speak():
        os.set_blocking(device_end, False)
        while not over.wait(0.005):
            try:
                os.read(device_end, 100)
            except BlockingIOError:
                continue
            os.write(device_end, answer)

    thread = threading.Thread(target=speak)
    thread.start()
    yield path
    over.set()
    thread.join()
