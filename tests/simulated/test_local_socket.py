"""A socket of this computer as a simulated device's port."""

import socket
import time

import pytest

from palpate.core.errors import PalpateError
from palpate.core.servo.socket_port import SocketPort, address_of
from palpate.simulated.wire import ports
from palpate.simulated.wire.local_socket import LocalSocket

ANYWHERE = "socket://127.0.0.1:0"


@pytest.fixture
def port():
    made = LocalSocket(ANYWHERE)
    yield made
    made.unplug()


def heard(port, count, seconds=20.0):
    """What the device reads until it has so many bytes."""
    data, deadline = b"", time.monotonic() + seconds
    while len(data) < count and time.monotonic() < deadline:
        data += port.read(0.0)
    return data


def test_bytes_go_both_ways(port):
    with SocketPort(port.path, timeout=20.0) as host:
        assert host.in_waiting == 0
        host.write(b"force")
        assert heard(port, 5) == b"force"
        port.write(b"state")
        assert host.read(5) == b"state"


def test_the_next_host_finds_nothing_of_the_one_before(port):
    with SocketPort(port.path, timeout=20.0) as host:
        host.write(b"1")
        assert heard(port, 1) == b"1"
    port.write(b"too late")
    assert heard(port, 1, seconds=0.1) == b""
    port.write(b"nobody is there")
    with SocketPort(port.path, timeout=20.0) as host:
        host.write(b"2")
        assert heard(port, 1) == b"2"
        port.write(b"state")
        assert host.read(5) == b"state"


def test_a_host_that_comes_before_the_last_word_of_the_one_before_was_read_is_not_hung_up_on(port):
    with SocketPort(port.path, timeout=20.0) as host:
        host.write(b"1")
        assert heard(port, 1) == b"1"
        host.write(b"last word")
    with socket.create_connection(address_of(port.path)) as second:
        assert port.read(0.0) == b"last word"
        second.sendall(b"2")
        assert heard(port, 1) == b"2"


def test_a_second_host_is_hung_up_on(port):
    with SocketPort(port.path, timeout=20.0) as host:
        host.write(b"1")
        assert heard(port, 1) == b"1"
        second = socket.create_connection(address_of(port.path))
        with second:
            assert heard(port, 1, seconds=0.1) == b""
            second.settimeout(20.0)
            assert second.recv(1) == b""
        port.write(b"state")
        assert host.read(5) == b"state"


def test_what_a_host_does_not_read_is_dropped(port):
    with SocketPort(port.path, timeout=20.0) as host:
        host.write(b"1")
        assert heard(port, 1) == b"1"
        frame = bytes(range(1, 100)) + b"\0"
        for _ in range(100_000):
            port.write(frame)
            if port.dropped:
                break
        assert port.dropped
        begun = host.read(100)
        assert begun == frame[: len(begun)]


def test_it_comes_back_at_its_path(port):
    path = port.path
    with SocketPort(path, timeout=20.0) as host:
        host.write(b"1")
        assert heard(port, 1) == b"1"
        port.unplug()
        with pytest.raises(ConnectionError):
            host.read(1)
        assert not port.plugged
        assert port.read(0.0) == b""
        with pytest.raises(ConnectionRefusedError):
            SocketPort(path, timeout=20.0)
    port.plug_in()
    assert port.path == path
    with SocketPort(path, timeout=20.0) as host:
        host.write(b"2")
        assert heard(port, 1) == b"2"


def test_a_taken_address_is_named(port):
    with pytest.raises(PalpateError, match=r"socket://127.0.0.1:\d+: nobody can listen there"):
        LocalSocket(port.path)


@pytest.mark.parametrize("name", ["socket://192.0.2.1:4000", "socket://here:1", "socket://"])
def test_another_computer_is_refused(name):
    with pytest.raises(PalpateError, match="no socket of this computer"):
        LocalSocket(name)


def test_without_pseudo_terminals_there_are_sockets_and_no_links(monkeypatch):
    monkeypatch.setattr(ports, "HAS_PSEUDO_TERMINALS", False)
    made = ports.device_port("")
    assert isinstance(made, LocalSocket)
    made.unplug()
    with pytest.raises(PalpateError, match=r"no links to ports; name a socket"):
        ports.device_port("somewhere/port")


def test_a_host_that_comes_in_the_moment_in_which_the_last_one_goes_is_not_hung_up_on(port):
    first = socket.create_connection(address_of(port.path))
    first.sendall(b"1")
    assert heard(port, 1) == b"1"
    listening, came = port._listening, []

    class LateListening:
        """Hears of the second host only after it was asked for."""

        def accept(self):
            if not came:
                first.close()
                came.append(socket.create_connection(address_of(port.path)))
                came[0].sendall(b"2")
            return listening.accept()

    port._listening = LateListening()
    try:
        assert heard(port, 1) == b"2"
    finally:
        port._listening = listening
        for second in came:
            second.close()
