"""How old FORCE is when a line has carried it, through a relay between two real pseudo-terminals.

    python benchmarks/servo/force_age.py [--seconds S] [--protocol 1|2]

The relay passes bytes on at the line's speed, one after the other, in each direction; what waits
for its turn waits there, and there is room for all. A row for each speed and rate of STATE: how
long FORCE waited behind others, beyond the time that the line takes for it. The device is at rest
off the body, so that FORCE has *enable* and no force. What came while the relay itself was held
up, and what waits behind that, is left out; a host that was held up is not.
"""

from __future__ import annotations

import argparse
import os
import time
import tty
from collections import deque
from dataclasses import dataclass, field

import numpy as np
from palpate_servo import LinkDevice, Servo

from palpate.core.servo import link
from palpate.core.servo.settings import Settings
from palpate.simulated.attack.target import YOUNG_MODULUS, cube
from palpate.simulated.board.simulated_firmware import Firmware

BAUDS = (9_600, 19_200, 57_600, 115_200, 250_000, 1_000_000)
RATES_HZ = (100, 400, 1000)
BITS = 10
LOOK_SECONDS = 1e-4
ABOVE_UM = (25_000, 25_000, 100_000)
ROOM_BYTES = 32
"""The device leaves out a STATE that would wait behind more."""
TICK_MS = 1.0
FORCE_BYTES = 22
"""At most one FORCE is ahead of another, and comes a tick late."""


@dataclass
class Direction:
    """Bytes on their way."""

    seconds_per_byte: float
    free_at: float = 0.0
    frames: deque[tuple[float, bytes]] = field(default_factory=deque)

    def put(self, frame: bytes, now: float) -> float:
        """Give it a frame; how long that waits for others, s."""
        waits = max(0.0, self.free_at - now)
        self.free_at = now + waits + len(frame) * self.seconds_per_byte
        self.frames.append((self.free_at, frame))
        return waits

    def take(self, now: float) -> bytes:
        """What has arrived."""
        arrived = b""
        while self.frames and self.frames[0][0] <= now:
            arrived += self.frames.popleft()[1]
        return arrived

    def waiting(self, now: float) -> float:
        """Bytes that have not been carried yet."""
        return max(0.0, self.free_at - now) / self.seconds_per_byte


class Relay:
    """A line between a device in this process and a host at `port`."""

    def __init__(self, baud: int, rate_hz: int, protocol: int) -> None:
        self._end, self._kept = os.openpty()
        tty.setraw(self._kept)
        os.set_blocking(self._end, False)
        self.port = os.ttyname(self._kept)
        hello = link.DeviceHello("Slow", 3, 3.0, (0.1, 0.1, 0.1), rate_hz, protocol)
        self._device, self._period = Firmware(hello), 1.0 / rate_hz
        self._there, self._back = Direction(BITS / baud), Direction(BITS / baud)
        self._begun, self._next_state, self._rest = time.monotonic(), 0.0, b""
        self._looked = self._spoilt_until = 0.0
        self.waits_ms: list[float] = []

    def close(self) -> None:
        """Let go of the terminal."""
        os.close(self._end)
        os.close(self._kept)

    def look(self) -> None:
        """Pass on what there is."""
        now = time.monotonic() - self._begun
        self._hear(now)
        self._back.put(self._device.receive(self._there.take(now), now), now)
        self._back.put(self._device.watch(now, LOOK_SECONDS), now)
        if now >= self._next_state:
            self._next_state = max(self._next_state + self._period, now)
            if self._back.waiting(now) <= ROOM_BYTES:
                self._back.put(self._device.state(now, ABOVE_UM, 0), now)
        if arrived := self._back.take(now):
            os.write(self._end, arrived)
        self._looked = now

    def _hear(self, now: float) -> None:
        try:
            heard = self._rest + os.read(self._end, 4096)
        except BlockingIOError:
            return
        is_held_up = now - self._looked > 10 * LOOK_SECONDS
        *frames, self._rest = heard.split(b"\0")
        for frame in frames:
            waits = self._there.put(frame + b"\0", now)
            if not is_held_up and now > self._spoilt_until and _pushes(frame + b"\0"):
                self.waits_ms.append(waits * 1e3)
        if is_held_up:
            self._spoilt_until = self._there.free_at


def _pushes(frame: bytes) -> bool:
    """Whether a frame is a FORCE with a flag."""
    messages = link.Decoder().feed(frame)
    return any(isinstance(message, link.Force) and message.flags for message in messages)


def measure(baud: int, rate_hz: int, protocol: int, seconds: float) -> tuple[list[float], dict]:
    """Waits of FORCE, ms, and the faults by name."""
    relay = Relay(baud, rate_hz, protocol)
    with Servo(cube(), Settings(YOUNG_MODULUS), ramp_seconds=0.05) as servo:
        servo.start(LinkDevice(relay.port))
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            relay.look()
            time.sleep(LOOK_SECONDS)
        faults = {name: count for name, count in servo.counters()["faults"].items() if count}
    relay.close()
    return relay.waits_ms, faults


def main() -> int:
    """Print the table; 1 if a FORCE waited longer than promised."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=3.0, help="for each row")
    parser.add_argument("--protocol", type=int, choices=(1, 2), default=2)
    arguments = parser.parse_args()
    print(f"protocol {arguments.protocol}; FORCE with enable that waited, ms")
    print(f"{'baud':>9}{'Hz':>6}{'FORCE':>8}{'median':>9}{'p99':>9}{'max':>9}  faults")
    broken = 0
    for baud in BAUDS:
        for rate_hz in RATES_HZ:
            waits, faults = measure(baud, rate_hz, arguments.protocol, arguments.seconds)
            figures = np.percentile(waits, [50, 99, 100]) if waits else [np.nan] * 3
            promised = TICK_MS + FORCE_BYTES * BITS / baud * 1e3
            broken += max(waits, default=0.0) > promised
            cells = "".join(f"{figure:9.2f}" for figure in figures)
            print(f"{baud:9}{rate_hz:6}{len(waits):8}{cells}  {faults or ''}", flush=True)
    print(f"{broken} rows with more than a tick and the time of one FORCE")
    return int(broken > 0)


if __name__ == "__main__":
    raise SystemExit(main())
