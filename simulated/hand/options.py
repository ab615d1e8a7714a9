"""Options of the simulated device, for command line and code."""
# ruff: noqa: RUF009 - _option gives a field, not a value

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from ...core.errors import PalpateError
from ...core.servo.link import DAMPING_STEP, FIRST_PROTOCOL, PROTOCOL, DeviceHello
from .hand_script import HandScript, TurnScript, press_script, read_script, tilt_script
from .plant import Impedance, Vector


def _option(default: Any, unit: str, text: str) -> Any:
    """Field of the options, with what its help says."""
    return field(default=default, metadata={"unit": unit, "help": text})


@dataclass(frozen=True)
class SimulatedOptions:
    """Options of the device, of the hand that holds it, and of faults. SI units.

    Times count from the first HELLO, before which the hand waits at `rest`.
    """

    name: str = _option("Simulated", "TEXT", "name told in HELLO, at most 16 bytes")
    protocol: int = _option(PROTOCOL, "1|2", "newest protocol of the link that it speaks")
    rate_hz: int = _option(1000, "HZ", "rate of the device's own loop and of STATE")
    largest_force: float = _option(3.0, "N", "largest force of the motors")
    workspace: Vector = _option(
        (0.1, 0.1, 0.1), "XYZ", "half extents of the workspace told in HELLO"
    )
    resolution_um: int = _option(1, "UM", "step of the encoders in micrometres")
    mass: float = _option(0.1, "KG", "moving mass")
    damping: float = _option(0.5, "NS/M", "viscous friction")
    coulomb: float = _option(0.0, "N", "Coulomb friction of each axis; below it the axis sticks")
    force_step: float = _option(
        0.0, "N", "step of the motors' force, as of their current (0: none)"
    )
    brake: float = _option(20.0, "NS/M", "damping added while the host asks for it")
    hand_stiffness: float = _option(500.0, "N/M", "spring between the hand and the device")
    hand_damping: float = _option(10.0, "NS/M", "damper between the hand and the device")
    rest: Vector = _option((0.0, 0.0, 0.03), "XYZ", "where the hand waits for the host")
    at: Vector | None = _option(None, "XYZ", "where a press begins (default: where the hand rests)")
    by: Vector = _option((0.0, 0.0, 0.0), "XYZ", "how far a press goes from there")
    approach: float = _option(1.0, "S", "time from rest to the beginning of the first press")
    period: float = _option(2.0, "S", "time of one press, in and out")
    hold: float = _option(0.0, "S", "of which the hand stays at the deepest point; inf: for good")
    script: str = _option(
        "", "FILE", "keyframes of the hand instead, CSV t,x,y,z[,qw,qx,qy,qz] or JSON"
    )
    turning: float | None = _option(
        None,
        "DEG",
        "tell an orientation; the hand tilts the stylus by so much and back (0: upright)",
    )
    turning_axis: Vector = _option((1.0, 0.0, 0.0), "XYZ", "axis of this, in the device's axes")
    turning_period: float = _option(4.0, "S", "time of one tilt, there and back")
    loss: float = _option(0.0, "FRACTION", "of the frames vanishes, both ways")
    noise: float = _option(0.0, "FRACTION", "of the bits flips, both ways")
    delay: float = _option(0.0, "S", "on the way, each way")
    latency_timer: float = _option(
        0.0, "S", "bytes to the host are held back so long, as FTDI's adapters do"
    )
    jitter: float = _option(0.0, "S", "at most, by chance on top of the delay, each way")
    seed: int = _option(1, "N", "of loss, noise and jitter")
    unplug_at: float | None = _option(None, "S", "when the plug is pulled (needs a link to return)")
    unplug_for: float = _option(math.inf, "S", "until it is plugged in again")
    button_at: float | None = _option(None, "S", "when the button is pressed")
    button_for: float = _option(0.2, "S", "until it is released")
    link: str = _option(
        "",
        "PATH",
        "symbolic link that always leads to the port; or socket://127.0.0.1:PORT, a socket of this "
        "computer instead of a pseudo-terminal (PORT 0: any free one)",
    )

    def __post_init__(self) -> None:
        positive = ("rate_hz", "largest_force", "resolution_um", "mass")
        not_negative = (
            *("damping", "coulomb", "force_step", "brake", "hand_stiffness", "hand_damping"),
            *("delay", "jitter", "latency_timer", "unplug_for"),
        )
        for name in positive:
            if not (0 < getattr(self, name) < math.inf):
                raise PalpateError(f"simulated device: {_flag(name)} must be more than 0")
        for name in not_negative:
            if not getattr(self, name) >= 0.0:
                raise PalpateError(f"simulated device: {_flag(name)} must be at least 0")
        for name in ("loss", "noise"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise PalpateError(f"simulated device: {_flag(name)} is a fraction from 0 to 1")
        if self.protocol not in (FIRST_PROTOCOL, PROTOCOL):
            raise PalpateError("simulated device: --protocol is 1 or 2")
        if self.rate_hz > 0xFFFF:
            raise PalpateError("simulated device: --rate-hz must be at most 65535")
        if self.unplug_at is not None and math.isfinite(self.unplug_for) and not self.link:
            raise PalpateError("simulated device: to come back to its path it needs --link PATH")

    @property
    def hello(self) -> DeviceHello:
        """HELLO of the device."""
        brake = min(0xFFFF, round(self.brake / DAMPING_STEP))
        return DeviceHello(
            self.name,
            3,
            self.largest_force,
            self.workspace,
            self.rate_hz,
            self.protocol,
            0 if self.protocol == FIRST_PROTOCOL else brake,
        )

    @property
    def impedance(self) -> Impedance:
        """Impedance of device and hand."""
        return Impedance(
            self.mass, self.damping, self.hand_stiffness, self.hand_damping, self.coulomb
        )

    def hand_script(self) -> HandScript:
        """Script of the hand; raises PalpateError for an unreadable file or invalid times."""
        if self.script:
            return read_script(Path(self.script))
        at = self.rest if self.at is None else self.at
        timing = {"approach": self.approach, "period": self.period, "hold": self.hold}
        return press_script(self.rest, at, self.by, **timing)

    def turn_script(self, hand: HandScript) -> TurnScript | None:
        """Script of the stylus' rotation; None for a device without orientation.

        Raises PalpateError for contradicting or invalid options.
        """
        if self.turning is None:
            return hand.turns
        if hand.turns is not None:
            raise PalpateError("simulated device: the script turns the stylus; omit --turning")
        return tilt_script(self.turning_axis, self.turning, self.turning_period)

    def arguments(self) -> list[str]:
        """Equivalent command line arguments."""
        line: list[str] = []
        for option in fields(self):
            value = getattr(self, option.name)
            if value != option.default:
                values = value if isinstance(value, tuple) else (value,)
                if len(values) == 1:
                    line.append(f"{_flag(option.name)}={values[0]}")
                else:
                    # argparse takes -5e-05 for an option unless a blank precedes it.
                    line += [_flag(option.name), *(f" {value!r}" for value in values)]
        return line


def add_simulated_options(parser: argparse.ArgumentParser) -> None:
    """Add one option to `parser` for each field of `SimulatedOptions`."""
    for option in fields(SimulatedOptions):
        unit = option.metadata["unit"]
        vector = unit == "XYZ"
        kind = float if vector or option.default is None else type(option.default)
        default = "" if option.default in (None, "") else " (default: %(default)s)"
        parser.add_argument(
            _flag(option.name),
            dest=option.name,
            type=kind,
            nargs=3 if vector else None,
            metavar=("X", "Y", "Z") if vector else unit,
            default=option.default,
            help=option.metadata["help"] + default,
        )


def simulated_options(arguments: argparse.Namespace) -> SimulatedOptions:
    """Options read by a parser with `add_simulated_options`; raises PalpateError."""
    given: dict[str, Any] = {
        option.name: getattr(arguments, option.name) for option in fields(SimulatedOptions)
    }
    values: dict[str, Any] = {
        name: tuple(one) if isinstance(one, list) else one for name, one in given.items()
    }
    return SimulatedOptions(**values)


def _flag(name: str) -> str:
    return "--" + name.replace("_", "-")
