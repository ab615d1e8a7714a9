"""Serial ports, the devices plugged in, and their answers to HELLO."""

from __future__ import annotations

import dataclasses
import errno
import os
import struct
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import serial
from serial.tools.list_ports import comports

from ..errors import PalpateError
from ..sentence import Sentence
from . import link
from .haply_models import HAPI_USB_IDS
from .latency_timer import ask_for_low_latency, explain_readings
from .port_error import REASONS, PortError, port_error
from .round_trip import RoundTrip
from .socket_port import SocketPort, address_of, is_socket

BAUD = 115200
"""Speed of a port whose speed nobody has said, bits a second."""
BAUDS = (300, 12_000_000)
"""Slowest and fastest that can be said."""
ANSWER_SECONDS = 2.5
"""Wait for HELLO: boards that restart when opened need up to two seconds."""
HELLO_EVERY_SECONDS = 0.1
READ_SECONDS = 0.02
LISTEN_SECONDS = 0.4
"""Time to watch STATE: 25 bursts of an adapter with its default timer."""
# Linux: whether another process has exclusive access; unnamed in Python 3.11.
_TIOCGEXCL = 0x80045440


@dataclass(frozen=True)
class Port:
    """Serial port; texts are empty where nothing is known."""

    path: str
    description: str = ""
    vendor: str = ""
    product: str = ""
    usb_id: str = ""
    """VID:PID in hexadecimal."""
    hello: link.DeviceHello | None = None
    """The device's answer."""
    tells_orientation: bool = False
    """Whether an ORIENTATION was heard."""
    round_trip_ms: float | None = None
    """From a FORCE to the STATE that names it, on average; None in protocol 1."""
    reason: str = ""
    """Reason why there is no answer."""
    warning: str = ""
    """Problem of the connection, with its remedy."""


def check_baud(baud: int | None) -> None:
    """Raise PalpateError for a speed that no line has; None is one that nobody has said."""
    slowest, fastest = BAUDS
    if baud is not None and not slowest <= baud <= fastest:
        raise PalpateError(
            "--baud: a line has {slowest} to {fastest} bits a second, not {baud}",
            slowest=slowest,
            fastest=fastest,
            baud=baud,
        )


def list_ports(
    extra: Sequence[str] = (), seconds: float = ANSWER_SECONDS, baud: int = BAUD
) -> list[Port]:
    """All ports of this computer, then `extra` paths, each asked for HELLO for up to `seconds`.

    Ports that are no USB devices, and possible Haply 2DIYs, are asked only if among `extra`: they
    may be the console, or a machine that expects something else. Those of `extra` are listened to
    a little longer, for the `warning` and the orientation.
    """
    found = [
        Port(
            path=port.device,
            description="" if port.description == "n/a" else port.description,
            vendor=port.manufacturer or "",
            product=port.product or "",
            usb_id="" if port.vid is None else f"{port.vid:04x}:{port.pid:04x}",
        )
        for port in comports()
    ]
    known = {port.path for port in found}
    found += [Port(path) for path in dict.fromkeys(extra) if path not in known]
    with ThreadPoolExecutor(max_workers=8) as pool:
        return list(pool.map(lambda port: _asked(port, port.path in extra, seconds, baud), found))


def _asked(port: Port, named: bool, seconds: float, baud: int) -> Port:
    hello, turns, reason, warning = None, False, "", ""
    trip = RoundTrip()
    if port.usb_id in HAPI_USB_IDS and not named:
        # A byte of HELLO resets a hAPI board's device.
        reason = (
            "not asked, as it may be a Haply 2DIY, which HELLO would confuse; try 'palpate servo "
            f"BODY.npz --haply {port.path}', or name it with --port to ask it"
        )
    elif port.usb_id or named:
        try:
            listen_seconds = LISTEN_SECONDS if named else 0.0
            hello, heard = _ask(port.path, seconds, baud, listen_seconds, trip)
            turns = any(isinstance(m, link.Orientation) for _, said in heard for m in said)
            warning = explain_readings(list(_readings(heard)), port.path) or ""
        except PortError as error:
            reason = error.reason
    else:
        reason = "not asked, as it is no USB device; name it with --port to ask it"
    return dataclasses.replace(
        port,
        hello=hello,
        tells_orientation=turns,
        round_trip_ms=trip.milliseconds,
        reason=reason,
        warning=warning,
    )


def say_hello(path: str, seconds: float = ANSWER_SECONDS) -> link.DeviceHello:
    """Answer of the device at `path` to HELLO.

    Raises PortError when the port cannot be opened or is in use, when nothing answers within
    `seconds`, and when the device speaks another version of the link.
    """
    return _ask(path, seconds, BAUD, 0.0, RoundTrip())[0]


Heard = list[tuple[float, list[link.Message]]]
"""Time of a reading, s, and its messages."""


def _ask(
    path: str, seconds: float, baud: int, listen_seconds: float, trip: RoundTrip
) -> tuple[link.DeviceHello, Heard]:
    """Answer to HELLO, and what was heard after it."""
    _look_at(path, even_if_taken=False)
    try:
        with _opened(path, baud) as port:
            return _exchange(path, port, seconds), list(_listen(port, listen_seconds, trip))
    except serial.SerialTimeoutException as error:
        raise PortError(path, _silence(seconds)) from error
    except OSError as error:
        raise port_error(path, error) from error


def _opened(path: str, baud: int) -> serial.Serial | SocketPort:
    if is_socket(path):
        return SocketPort(path, timeout=READ_SECONDS)
    return serial.Serial(path, baud, timeout=READ_SECONDS, write_timeout=0.5, exclusive=True)


def check_port(path: str) -> None:
    """Check that `path` can be opened, without sending anything; raises PortError.

    Also asks the port's driver for low latency.
    """
    _look_at(path, even_if_taken=True)


def _look_at(path: str, *, even_if_taken: bool) -> None:
    if is_socket(path):
        address_of(path)
        return
    if sys.platform == "win32":
        # It would open, and then know nothing of a line.
        if os.path.isfile(path):  # noqa: PTH113 - a Path would take part of a port's name away
            raise PortError(path, REASONS[errno.ENOTTY])
        if even_if_taken:  # Else it is opened next; twice in a row is too much for some drivers.
            _open_once(path)
        return
    import fcntl

    try:
        descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    except OSError as error:
        raise port_error(path, error) from error
    try:
        if not os.isatty(descriptor):
            raise PortError(path, REASONS[errno.ENOTTY])
        if sys.platform == "linux" and not even_if_taken:
            # The superuser may open exclusive ports, and would steal their bytes.
            taken = fcntl.ioctl(descriptor, _TIOCGEXCL, struct.pack("i", 0))
            if struct.unpack("i", taken)[0]:
                raise PortError(path, REASONS[errno.EBUSY])
        # While the port is open: opening it again may restart a board.
        ask_for_low_latency(descriptor)
    finally:
        os.close(descriptor)


def _open_once(path: str) -> None:
    """Open and close a COM port of Windows, where a name above COM9 needs the long form."""
    try:
        os.close(os.open(path if path.startswith("\\\\") else rf"\\.\{path}", os.O_RDWR))
    except OSError as error:
        raise port_error(path, error) from error


def _exchange(path: str, port: serial.Serial | SocketPort, seconds: float) -> link.DeviceHello:
    decoder = link.Decoder()
    deadline = time.monotonic() + seconds
    next_hello = 0.0
    while (now := time.monotonic()) < deadline:
        if now >= next_hello:
            next_hello = now + HELLO_EVERY_SECONDS
            port.write(link.encode(link.HostHello(link.PROTOCOL)))
        for message in decoder.feed(port.read(max(1, port.in_waiting))):
            match message:
                case link.DeviceHello(protocol=protocol):
                    if protocol != link.PROTOCOL:
                        # It streams to whoever asks in its own words.
                        port.write(link.encode(link.HostHello(protocol)))
                    return message
                case link.OtherHello(protocol):
                    raise PortError(
                        path,
                        Sentence(
                            "speaks version {protocol} of the link, this Palpate speaks version "
                            "{own}; update the older of the two",
                            protocol=protocol,
                            own=link.PROTOCOL,
                        ),
                    )
    raise PortError(path, _silence(seconds))


def _listen(
    port: serial.Serial | SocketPort, seconds: float, trip: RoundTrip
) -> Iterator[tuple[float, list[link.Message]]]:
    """Messages with their times; readings without bytes have none. Each STATE is answered."""
    decoder = link.Decoder()
    port.timeout = 1e-3
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        data = port.read(max(1, port.in_waiting))
        messages = decoder.feed(data)
        states = [message for message in messages if isinstance(message, link.State)]
        if states:
            port.write(trip.answer(states[-1], time.monotonic()))
        # Part of a frame: neither a message nor an empty reading.
        if messages or not data:
            yield time.monotonic(), messages


def _readings(heard: Heard) -> Iterator[tuple[float, list[int]]]:
    """Readings of STATE for `explain_readings`."""
    for when, messages in heard:
        stamps = [m.device_time_us for m in messages if isinstance(m, link.State)]
        # Nor is an ORIENTATION alone.
        if stamps or not messages:
            yield when, stamps


def _silence(seconds: float) -> Sentence:
    return Sentence(
        "does not answer HELLO within {seconds:g} s; check that it is a haptic device that speaks "
        "Palpate's link",
        seconds=seconds,
    )
