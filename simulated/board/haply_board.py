"""Simulated 2DIY: a five-bar arm in a hand, a hAPI board and its port.

The handle is a mass in the plane (`plant.py`), seen by encoders and moved by motors through the
arm's geometry. The firmware is `haply_firmware.py`.
"""

from __future__ import annotations

import math
from dataclasses import asdict, replace

from ...core.errors import PalpateError
from ...core.servo.haply_models import DEFAULT_MODEL, haply_model
from ..hand.hand_schedule import HandSchedule
from ..hand.options import SimulatedOptions
from ..hand.plant import Plant, Vector
from ..hand.quaternion import Quaternion
from ..wire.ports import device_port
from ..wire.wire_faults import BadWire
from .haply_firmware import PORTS, HaplyFirmware

RELEASE_AFTER_SECONDS = 0.25


class ByteFaults(BadWire):
    """One direction of an unframed line: single bytes are lost, with flipped bits and a delay."""

    def put(self, data: bytes, now: float) -> None:
        """Send bytes at `now`."""
        if data:
            self._in_flight.append((now + self._delay, self._through(data)))

    def _through(self, data: bytes) -> bytes:
        noise = 1.0 - (1.0 - self._noise) ** 8
        if not (self._loss or noise):
            return data
        passed = bytearray()
        for byte in data:
            if self._random.random() < self._loss:
                self.lost += 1
            elif self._random.random() < noise:
                self.flipped += 1
                passed.append(byte ^ 1 << self._random.randrange(8))
            else:
                passed.append(byte)
        return bytes(passed)


class HaplyBoard:
    """2DIY, advanced in steps; the counterpart of `SimulatedBoard`, which speaks the link.

    The hand waits in the rest pose, or at `options.rest` if not the default, until the first host
    sets the board up. Options of the hand, the moving mass and its friction, the plug, loss (of
    bytes), noise and delay apply; encoders and motors are the model's. Heights are 0.

    Raises PalpateError for an unknown model and for invalid options.
    """

    def __init__(self, options: SimulatedOptions, model: str = DEFAULT_MODEL) -> None:
        self.model = haply_model(model)
        if options.rest == SimulatedOptions().rest:
            options = replace(options, rest=self.model.rest)
        self._schedule = HandSchedule(options)
        if self._schedule.turned(0.0) is not None:
            raise PalpateError("simulated 2DIY: it cannot tell how it is turned; omit --turning")
        self._unplugged = 0
        start = self._schedule.hand(0.0)
        self.plant = Plant(options.impedance, 1.0 / options.rate_hz, start)
        self._degrees = self.model.angles(start) or self.model.rest_degrees
        self._force: Vector = (0.0, 0.0, 0.0)
        self._largest_force = 0.0
        self._to_device, self._to_host = (
            ByteFaults(options.loss, options.noise, options.delay, 2 * options.seed + way)
            for way in (0, 1)
        )
        self.firmware = HaplyFirmware(self._counts)
        self.port = device_port(options.link, RELEASE_AFTER_SECONDS)

    def tick(self, now: float, steps: int) -> None:
        """Read the host, move by `steps` periods, answer."""
        self._schedule.keep_plug(now, self.unplug, self.plug_in)
        self._to_device.put(self.port.read(now), now)
        self.firmware.receive(self._to_device.take(now))
        self._to_host.put(self.firmware.run(now), now)
        if self.firmware.counters.setups:
            self._schedule.host_came(now)
        self._move(now, steps)
        self.port.write(self._to_host.take(now))

    def move_hand(self, now: float, position: Vector, seconds: float) -> None:
        """Leave the script: move the hand to `position` and stay."""
        self._schedule.move_hand(now, position, seconds)

    def turn_hand(self, now: float, rotation: Quaternion, seconds: float) -> None:
        """Do nothing: the device has no orientation."""

    def press_buttons(self, mask: int) -> None:
        """Do nothing: the device has no buttons."""

    def unplug(self) -> None:
        """Pull the plug, if it is in: the motors lose power too."""
        if self.port.plugged:
            self._unplugged += 1
            self.port.unplug()
            self.firmware = HaplyFirmware(self._counts, self.firmware.counters)

    def plug_in(self) -> None:
        """Put the plug back, if it is out: the board restarts without configuration."""
        if not self.port.plugged:
            self.port.plug_in()

    def report(self) -> dict[str, object]:
        """Counters and present state; SI units, angles in degrees."""
        plant = self.plant
        return {
            **asdict(self.firmware.counters),
            "plugged": self.port.plugged,
            "unplugged": self._unplugged,
            "torques": [self.firmware.torque(port) for port in range(PORTS)],
            "angles": self._degrees,
            "largest_force": self._largest_force,
            "felt_force": self._force,
            "hand_force": plant.hand_force,
            "position": plant.position,
            "velocity": plant.velocity,
            "target": plant.target,
            "work_of_felt_force": plant.work,
            "bytes_lost_on_purpose": self._to_device.lost + self._to_host.lost,
            "bits_flipped_on_purpose": self._to_device.flipped + self._to_host.flipped,
        }

    def _move(self, now: float, steps: int) -> None:
        period = self.plant.step_seconds
        for remaining in range(steps - 1, -1, -1):
            self._force = self._motor_force()
            self._largest_force = max(self._largest_force, math.hypot(*self._force))
            x, y, _ = self._schedule.hand(now, remaining * period)
            self.plant.step(self._force, (x, y, 0.0))
            # Beyond the arms' reach the elbows stay.
            self._degrees = self.model.angles(self.plant.position) or self._degrees

    def _motor_force(self) -> Vector:
        first, second = (
            self.firmware.torque(port) * (1.0 if sense == 0 else -1.0)
            for port, sense in zip(self.model.ports, self.model.motor_senses, strict=True)
        )
        radians = (math.radians(self._degrees[0]), math.radians(self._degrees[1]))
        return self.model.device_force(self.model.arm.handle_force(radians, (first, second)))

    def _counts(self) -> list[int]:
        counts = [0] * PORTS
        for port, sense, degrees, resolution in zip(
            self.model.ports,
            self.model.encoder_senses,
            self._degrees,
            self.model.resolutions,
            strict=True,
        ):
            count = math.floor(degrees * resolution / 2.0 / 360.0)
            counts[port] = count if sense == 0 else -count
        return counts
