"""Ports with nobody, or somebody else, behind them."""

import os
import threading
import tty

import pytest

from palpate.core.servo import link


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
    """The path of a device that answers whatever it hears in protocol 3."""
    device_end, path = terminal
    answer = link.frame(b"\x01\x03 of a later time")
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
