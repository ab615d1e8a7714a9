"""Simulated device: hand and mass, firmware, faulty wires, port."""

from __future__ import annotations

from dataclasses import asdict

from ..hand.hand_schedule import HandSchedule
from ..hand.options import SimulatedOptions
from ..hand.plant import Plant, Vector
from ..hand.quaternion import Quaternion
from ..wire.ports import device_port
from ..wire.wire_faults import BadWire
from .simulated_firmware import Firmware


class SimulatedBoard:
    """Device advanced by `tick`; times are seconds since power-on. Raises PalpateError."""

    def __init__(self, options: SimulatedOptions) -> None:
        self._options = options
        self._schedule = HandSchedule(options)
        self._buttons_by_command = 0
        self._unplugged = 0
        self.firmware = Firmware(options.hello)
        start = self._schedule.hand(0.0)
        self.plant = Plant(options.impedance, 1.0 / options.rate_hz, start, options.brake)
        self._lowest, self._highest = start, start
        self._to_device, self._to_host = (
            BadWire(options.loss, options.noise, options.delay, seed, latency_timer, options.jitter)
            for seed, latency_timer in (
                (2 * options.seed, 0.0),
                (2 * options.seed + 1, options.latency_timer),
            )
        )
        self.port = device_port(options.link)

    def tick(self, now: float, steps: int) -> None:
        """Read the host, move by `steps` of the device's period, send STATE."""
        self._schedule.keep_plug(now, self.unplug, self.plug_in)
        self._to_device.put(self.port.read(now), now)
        answer = self.firmware.receive(self._to_device.take(now), now)
        if self.firmware.counters.hellos:
            self._schedule.host_came(now)
        answer += self.firmware.watch(now, self.plant.step_seconds)
        self._move(now, steps)
        turned = self._schedule.turned(now)
        if turned is not None:
            answer += self.firmware.orientation(turned)
        answer += self.firmware.state(now, self._encoders(), self._buttons(now))
        self._to_host.put(answer, now)
        self.port.write(self._to_host.take(now))

    def move_hand(self, now: float, position: Vector, seconds: float) -> None:
        """Leave the script: move the hand to `position` and stay."""
        self._schedule.move_hand(now, position, seconds)

    def turn_hand(self, now: float, rotation: Quaternion, seconds: float) -> None:
        """Leave the script: turn the stylus to `rotation` (unit) and stay; from now on it is sent.

        The stylus has no rotational inertia: it follows the hand.
        """
        self._schedule.turn_hand(now, rotation, seconds)

    def press_buttons(self, mask: int) -> None:
        """Hold exactly the buttons of `mask` (8 bits) from now on."""
        self._buttons_by_command = mask & 0xFF

    def unplug(self) -> None:
        """Pull the plug, if it is in."""
        if self.port.plugged:
            self._unplugged += 1
            self.port.unplug()

    def plug_in(self) -> None:
        """Put the plug back, if it is out: the board restarts."""
        if not self.port.plugged:
            self.firmware.plug_in()
            self.port.plug_in()

    def report(self) -> dict[str, object]:
        """Counters and present state; SI units."""
        plant = self.plant
        return {
            **asdict(self.firmware.counters),
            **asdict(self.firmware.decoder.errors),
            "states_dropped": self.port.dropped,
            "limp": self.firmware.limp,
            "plugged": self.port.plugged,
            "unplugged": self._unplugged,
            "felt_force": self.firmware.force,
            "hand_force": plant.hand_force,
            "position": plant.position,
            "velocity": plant.velocity,
            "target": plant.target,
            "position_min": self._lowest,
            "position_max": self._highest,
            "work_of_felt_force": plant.work,
            "work_of_hand": plant.energy.hand,
            "taken_by_viscous_friction": plant.energy.viscous,
            "taken_by_coulomb_friction": plant.energy.coulomb,
            "kinetic_energy": plant.kinetic,
            "frames_lost_on_purpose": self._to_device.lost + self._to_host.lost,
            "bits_flipped_on_purpose": self._to_device.flipped + self._to_host.flipped,
        }

    def _move(self, now: float, steps: int) -> None:
        period = self.plant.step_seconds
        force, braked = self._motors(self.firmware.force), self.firmware.braked
        for remaining in range(steps - 1, -1, -1):
            target = self._schedule.hand(now, remaining * period)
            self.plant.step(force, target, braked)
        here = self.plant.position
        (x, y, z), (x0, y0, z0), (x1, y1, z1) = here, self._lowest, self._highest
        self._lowest = (min(x, x0), min(y, y0), min(z, z0))
        self._highest = (max(x, x1), max(y, y1), max(z, z1))

    def _motors(self, force: Vector) -> Vector:
        grain = self._options.force_step
        if grain == 0.0:
            return force
        x, y, z = (round(component / grain) * grain for component in force)
        return (x, y, z)

    def _encoders(self) -> tuple[int, int, int]:
        grain = self._options.resolution_um
        x, y, z = (round(metres * 1e6 / grain) * grain for metres in self.plant.position)
        return (x, y, z)

    def _buttons(self, now: float) -> int:
        at, held = self._options.button_at, 0
        if at is not None:
            held = int(at <= self._schedule.since_host(now) < at + self._options.button_for)
        return self._buttons_by_command | held
