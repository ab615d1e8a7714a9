"""Firmware of a hAPI board, as of the M0 board.

A loop of at least 50 us reads one command. Single bytes are read without waiting: 255 if none has
come. Floats are awaited for up to a second; missing bytes keep what memory held. Messages have no
start mark and no checksum, and there is no watchdog: motors keep their torque until the next
command.

No clock and no port of its own: times, bytes and encoders are arguments.
"""

from __future__ import annotations

import math
import struct
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

LOOP_SECONDS = 50e-6
READ_SECONDS = 1.0
PORTS = 2
PWM_PINS = 14
ANALOG_PINS = 5
PWM_STEPS = 1023
TORQUE_AT_FULL_DUTY = 0.156
"""N m, the firmware's number, whatever the motors' own torque."""
RESET, SETUP, TORQUES = 0, 1, 2
NOTHING_READ = 0xFF


@dataclass
class Port:
    """Port with a motor and an encoder; address 0 for unused ones."""

    motor_address: int = 0
    encoder_address: int = 0
    motor_sense: int = 0
    encoder_sense: int = 0
    duty: int = 0
    """PWM steps, signed by the direction."""
    resolution: float = 0.0
    count_at_zero: int = 0
    """Offset of the encoder's own count, in its sense."""


@dataclass
class HaplyCounters:
    """Counters of the board."""

    resets: int = 0
    setups: int = 0
    answers: int = 0
    bytes_skipped: int = 0
    """Bytes where a command should have been."""
    read_timeouts: int = 0


@dataclass
class _Wait:
    count: int
    deadline: float
    then: Callable[[bytes], bytes]


def _no_counts() -> list[int]:
    return [0] * PORTS


@dataclass
class HaplyFirmware:
    """Board's side of the hAPI protocol. `encoders` are the counts of the two encoders."""

    encoders: Callable[[], list[int]] = field(default=_no_counts)
    counters: HaplyCounters = field(default_factory=HaplyCounters)
    ports: list[Port] = field(default_factory=lambda: [Port() for _ in range(PORTS)])
    _unread: deque[int] = field(default_factory=deque)
    _pwm_addresses: list[int] = field(default_factory=lambda: [0] * PWM_PINS)
    _analog_addresses: list[int] = field(default_factory=lambda: [0] * ANALOG_PINS)
    _wait: _Wait | None = None
    _next_loop: float = 0.0
    _memory: bytes = bytes(64)

    def torque(self, port: int) -> float:
        """Torque of the motor at a port, N m; positive for a positive command of sense 0."""
        return self.ports[port].duty / PWM_STEPS * TORQUE_AT_FULL_DUTY

    def receive(self, data: bytes) -> None:
        """Receive bytes from the host into the board's buffer."""
        self._unread.extend(data)

    def run(self, now: float) -> bytes:
        """Run until `now` (s, never decreasing); returns the bytes sent."""
        sent = b""
        while self._next_loop <= now:
            if self._wait is not None:
                if len(self._unread) < self._wait.count and now < self._wait.deadline:
                    return sent
                sent += self._go_on(self._wait)
            elif self._unread:
                sent += self._command(self._read(), self._next_loop)
            else:
                self._next_loop = max(now, self._next_loop)
                return sent
            if self._wait is None:
                self._next_loop += LOOP_SECONDS
        return sent

    def _read(self) -> int:
        return self._unread.popleft() if self._unread else NOTHING_READ

    def _read_bytes(self, count: int, now: float, then: Callable[[bytes], bytes]) -> bytes:
        wait = _Wait(count, now + READ_SECONDS, then)
        if len(self._unread) >= count:
            return self._go_on(wait)
        self._wait = wait
        return b""

    def _go_on(self, wait: _Wait) -> bytes:
        self._wait = None
        arrived = bytes(self._unread.popleft() for _ in range(min(wait.count, len(self._unread))))
        self.counters.read_timeouts += len(arrived) < wait.count
        # The rest of the buffer was never written.
        content = arrived + self._memory[len(arrived) : wait.count]
        self._memory = content + self._memory[len(content) :]
        return wait.then(content)

    def _command(self, command: int, now: float) -> bytes:
        if command == RESET:
            self._read()
            self._forget()
            self.counters.resets += 1
            return b""
        if command == SETUP:
            return self._set_up(now)
        if command == TORQUES:
            return self._take_torques(now)
        self.counters.bytes_skipped += 1
        return b""

    def _forget(self) -> None:
        # The motors keep their torque.
        for port in self.ports:
            port.motor_address = port.encoder_address = 0
        self._pwm_addresses = [0] * PWM_PINS
        self._analog_addresses = [0] * ANALOG_PINS

    def _set_up(self, now: float) -> bytes:
        self._forget()
        self.counters.setups += 1
        address = self._read()
        motors = self._mask()
        # Senses go to the first ports, whichever are in use, as in the original.
        for port in range(len(motors)):
            self.ports[port].motor_sense = self._read()
        encoders = self._mask()
        for port in range(len(encoders)):
            self.ports[port].encoder_sense = self._read()
        self._take_pins(self._analog_addresses, 54, address)
        self._take_pins(self._pwm_addresses, 0, address)

        def finish(parameters: bytes) -> bytes:
            for index, port in enumerate(encoders):
                offset, resolution = struct.unpack_from("<2f", parameters, 8 * index)
                self._start_encoder(port, address, offset, resolution)
            for port in motors:
                self.ports[port].motor_address = address
            return b""

        if not encoders:
            return finish(b"")
        return self._read_bytes(8 * len(encoders), now, finish)

    def _take_pins(self, addresses: list[int], first: int, address: int) -> None:
        for _ in range(self._read()):
            pin = self._read() - first
            if 0 <= pin < len(addresses):
                addresses[pin] = address

    def _mask(self) -> list[int]:
        bits = self._read()
        return [port for port in range(PORTS) if bits >> port & 1]

    def _start_encoder(self, port: int, address: int, offset: float, resolution: float) -> None:
        one = self.ports[port]
        one.encoder_address = address
        # Only half the edges are counted.
        one.resolution = resolution / 2.0
        count = offset * one.resolution / 360.0
        written = int(count) if math.isfinite(count) else 0
        one.count_at_zero = written - self._own_count(port)

    def _own_count(self, port: int) -> int:
        return self.encoders()[port] * (1 if self.ports[port].encoder_sense == 0 else -1)

    def _take_torques(self, now: float) -> bytes:
        address = self._read()
        for pin in range(PWM_PINS):
            if self._pwm_addresses[pin] == address:
                self._read()
        motors = [port for port in self.ports if port.motor_address == address]

        def finish(floats: bytes) -> bytes:
            for index, port in enumerate(motors):
                port.duty = _duty(struct.unpack_from("<f", floats, 4 * index)[0], port.motor_sense)
            return self._answer(address)

        if not motors:
            return finish(b"")
        return self._read_bytes(4 * len(motors), now, finish)

    def _answer(self, address: int) -> bytes:
        values = [0.0 for pin in self._analog_addresses if pin == address]
        for number, port in enumerate(self.ports):
            if port.encoder_address == address:
                count = self._own_count(number) + port.count_at_zero
                values.append(360.0 * count / port.resolution if port.resolution else math.nan)
        self.counters.answers += 1
        return bytes([address]) + struct.pack(f"<{len(values)}f", *values)


def _duty(torque: float, sense: int) -> int:
    if math.isnan(torque):
        return 0
    size = min(abs(torque), TORQUE_AT_FULL_DUTY)
    steps = int(PWM_STEPS * size / TORQUE_AT_FULL_DUTY)
    return steps if (torque > 0.0) == (sense == 0) else -steps
