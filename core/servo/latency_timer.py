"""FTDI's latency timer: shortened where the user may, and detected where not.

FTDI's USB serial adapters hold received bytes for up to 16 ms by default. STATE at 1 kHz then
arrives in bursts, 62.5 a second, and the force lags behind the probe (FTDI, application note
AN232B-04, "Data Throughput, Latency and Handshaking").
"""

from __future__ import annotations

import os
import struct
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..sentence import Sentence

# linux/serial.h: flags are the fifth number of struct serial_struct, which fits this size.
_SERIAL_STRUCT = struct.Struct("32i")
_FLAGS = 4
_ASYNC_LOW_LATENCY = 1 << 13
_DRIVER = Path("/sys/bus/usb-serial/devices")

FEWEST_BURSTS = 10
"""Least number of bursts that is no accident."""
BURST_SECONDS = 3.5e-3
"""Shortest pause that is no ordinary jitter."""
BURST_STATES = 3
"""Least number of STATE at once that is no accident."""


def ask_for_low_latency(descriptor: int) -> bool:
    """Ask the driver of an open port for low latency; whether it agreed.

    On Linux any user may, which sets FTDI's timer to 1 ms until the adapter is unplugged. Other
    systems have no such request, and ports without a timer refuse it: neither is a fault.
    """
    if sys.platform != "linux":
        return False
    import fcntl
    import termios

    try:
        answer = fcntl.ioctl(descriptor, termios.TIOCGSERIAL, bytes(_SERIAL_STRUCT.size))
        values = list(_SERIAL_STRUCT.unpack(answer))
        values[_FLAGS] |= _ASYNC_LOW_LATENCY
        fcntl.ioctl(descriptor, termios.TIOCSSERIAL, _SERIAL_STRUCT.pack(*values))
    except OSError:
        return False
    return True


def latency_timer_ms(path: str, driver: Path = _DRIVER) -> int | None:
    """Timer of the adapter at ``path``, ms; None if it has none or it is unknown."""
    try:
        return int((driver / Path(os.path.realpath(path)).name / "latency_timer").read_text())
    except (OSError, ValueError):
        return None


def explain(link: Mapping[str, Any], path: str = "") -> Sentence | None:
    """Warning with remedy where the adapter holds STATE back, else None.

    Parameters
    ----------
    link : the counters of a servo's link, ``servo.counters()["link"]``.
    path : of the port.
    """
    if link["bursts"] < FEWEST_BURSTS or 2 * link["burst_states"] < link["states"]:
        return None
    return _sentence(link["burst_ms"], link["state_interval_us"]["device"] * 1e-3, path)


def explain_readings(
    readings: Sequence[tuple[float, Sequence[int]]], path: str = ""
) -> Sentence | None:
    """Warning from readings of a port, by the rules of `native/src/device/arrival.rs`.

    Parameters
    ----------
    readings : time (s) of each reading and the device times (us) of its STATEs, if any.
    """
    pauses: list[float] = []
    held = states = 0
    device_seconds = in_vain = 0.0
    last: tuple[float, int] | None = None
    for now, stamps in readings:
        if not stamps:
            in_vain = now
            continue
        if last is not None:
            then, stamp = last
            pause, made = now - then, _since(stamps[0], stamps[-1])
            states += len(stamps)
            device_seconds += _since(stamp, stamps[-1])
            was_looked_for = in_vain - then >= BURST_SECONDS
            if was_looked_for and len(stamps) >= BURST_STATES and made >= 0.5 * pause:
                pauses.append(pause)
                held += len(stamps)
        last = now, stamps[-1]
    if len(pauses) < FEWEST_BURSTS or 2 * held < states:
        return None
    return _sentence(1e3 * sum(pauses) / len(pauses), 1e3 * device_seconds / states, path)


def _since(first_us: int, last_us: int) -> float:
    return (last_us - first_us) % 2**32 * 1e-6


def remedy(path: str = "", system: str = sys.platform) -> Sentence:
    """Instructions to set the timer to 1 ms."""
    if system == "win32":
        return Sentence(
            "in the Device Manager open the port's properties, Port Settings, Advanced, and set "
            "Latency Timer to 1 ms"
        )
    if system == "darwin":
        return Sentence(
            "install FTDI's own driver and set its LatencyTimer to 1 or 2 (FTDI's technical note "
            "TN_105 tells how), or use a device with USB of its own"
        )
    name = Path(os.path.realpath(path)).name if path else "ttyUSB0"
    return Sentence(
        "run 'echo 1 | sudo tee {timer}', or for good put {rule} into a file in /etc/udev/rules.d",
        timer=(_DRIVER / name / "latency_timer").as_posix(),
        rule='ACTION=="add", SUBSYSTEM=="usb-serial", DRIVER=="ftdi_sio", ATTR{latency_timer}="1"',
    )


def _sentence(burst_ms: float, device_ms: float, path: str) -> Sentence:
    timer = latency_timer_ms(path) if path else None
    known = Sentence(" (its latency timer is at {timer} ms)", timer=timer)
    said = Sentence(
        "STATE arrives in bursts, one every {burst:.3g} ms ({rate:.3g} Hz), though the device "
        "makes one every {device:.3g} ms: the USB serial adapter holds bytes back{timer}, and the "
        "force comes late; {remedy}",
        burst=burst_ms,
        rate=1e3 / burst_ms,
        device=device_ms,
        timer="" if timer is None else known,
        remedy=remedy(path),
    )
    return Sentence("{path}: {reason}", path=path, reason=said) if path else said
