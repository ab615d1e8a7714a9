"""A device or a user that goes wrong in the middle of a press."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import replace
from random import Random

import numpy as np

from ....core.servo import link
from .cause import STALE_TICKS, Cause, Inject, Outcome, anywhere, held, silent
from .line_causes import mute
from .shot import Shot
from .virtual_press import VirtualPress


def _button(press: VirtualPress, dice: Random) -> list[Shot]:
    return held(press, dice.randint(1, 60), buttons=1 << dice.randrange(8))


def _not_ready(press: VirtualPress, dice: Random) -> list[Shot]:
    return held(press, dice.randint(1, 60), flags=link.StateFlag(0))


def _fault_flag(press: VirtualPress, dice: Random) -> list[Shot]:
    return held(press, dice.randint(1, 60), flags=link.StateFlag.READY | link.StateFlag.FAULT)


def _fault_message(press: VirtualPress, dice: Random) -> list[Shot]:
    told = link.encode(link.Fault(dice.randint(128, 255), dice.randrange(1 << 16)))
    return [press.tick(lambda sent: told + sent)]


def _switch(press: VirtualPress, dice: Random) -> list[Shot]:
    press.servo.set(replace(press.settings, enabled=False))
    shots = [press.tick() for _ in range(dice.randint(1, 60))]
    press.servo.set(press.settings)
    return shots


def _jump(press: VirtualPress, dice: Random) -> list[Shot]:
    """An encoder that loses its place by half a metre to two thousand."""
    where = np.array([dice.gauss(0, 1) for _ in range(3)])
    press.position = where / np.linalg.norm(where) * 10 ** dice.uniform(-0.3, 3.3)
    shots = [press.tick() for _ in range(dice.randint(1, 150))]
    press.position = press.target.above.copy()
    return [*shots, press.tick()]


def _fast(clock: Callable[[float], Callable[[float], float]]) -> Inject:
    """At 3 to 8 m/s out of the body, by a clock that is wrong since the tick before."""

    def inject(press: VirtualPress, dice: Random) -> list[Shot]:
        press.clock = clock(press.now)
        press.tick()
        step = dice.uniform(3e-3, 8e-3)
        shots = []
        for _ in range(5):
            press.position = press.position - step * press.target.inward
            shots.append(press.tick())
        press.clock = float
        press.position = press.target.above.copy()
        return shots

    return inject


def _modulus(press: VirtualPress, dice: Random) -> list[Shot]:
    wrong = dice.choice([math.nan, math.inf, -math.inf, -1.0, 0.0])
    press.servo.set(replace(press.settings, young_modulus=wrong))
    shots = [press.tick() for _ in range(dice.randint(1, 20))]
    press.servo.set(press.settings)
    return shots


def _other_body(press: VirtualPress, _: Random) -> list[Shot]:
    press.servo.set_body(press.target.body, press.settings)
    return [press.tick()]


def _gap(press: VirtualPress, dice: Random) -> list[Shot]:
    """The hand goes on meanwhile, and the line stores what it can."""
    aside = np.array([dice.uniform(-0.01, 0.01), dice.uniform(-0.01, 0.01), 0.0])
    seconds = dice.uniform(0.021, 2.0)
    return [press.tick(seconds=seconds, by=aside * min(1.0, seconds / 0.1))]


def _unplug(press: VirtualPress, dice: Random) -> list[Shot]:
    press.servo.unplug()
    shots = [press.tick(lambda _: b"") for _ in range(dice.randint(1, 300))]
    press.servo.plug_in()
    press.device.plug_in()
    return shots


def _other_protocol(press: VirtualPress, dice: Random) -> list[Shot]:
    hello = link.frame(bytes([1, dice.randint(link.PROTOCOL + 1, 255)]))
    return [press.tick(lambda sent: sent + hello)]


def _unsound_hello(press: VirtualPress, dice: Random) -> list[Shot]:
    payload = bytearray(link.pack(press.device.hello))
    payload[19:23] = struct.pack("<f", dice.choice([math.nan, math.inf, -1.0]))
    hello = link.frame(bytes(payload))
    return [press.tick(lambda sent: sent + hello)]


def _other_figures(press: VirtualPress, dice: Random) -> list[Shot]:
    """Another device answers, or the same with other limits."""
    figures = replace(press.device.hello, largest_force=dice.uniform(5.0, 50.0))
    return [press.tick(lambda sent: sent + link.encode(figures))]


def _reset(press: VirtualPress, dice: Random) -> list[Shot]:
    """Silence, and then clock and encoders begin anew: it seems to be deep inside."""
    shots = mute(press, dice)
    begun = press.now
    press.clock = lambda time: time - begun
    press.position = press.position + dice.uniform(0.001, 0.03) * press.target.inward
    return shots


def _stiffer(press: VirtualPress, dice: Random) -> list[Shot]:
    stiffer = press.settings.young_modulus * dice.uniform(10, 1e6)
    press.servo.set(replace(press.settings, young_modulus=stiffer))
    shots = [press.tick() for _ in range(60)]
    press.servo.set(press.settings)
    return shots


DEVICE_CAUSES = (
    silent("the device's button is held", _button, "disabled: device button"),
    anywhere(silent("switched off by the user", _switch, "disabled: switched off")),
    silent("the device is not ready", _not_ready, "waiting: the device is not ready"),
    silent("the device's fault flag", _fault_flag, "device fault"),
    silent("a FAULT of the device", _fault_message, "device fault"),
    silent("the encoder loses its place", _jump, "too fast"),
    silent("faster than 2 m/s", _fast(lambda _: float), "too fast"),
    silent("the same, its clock stands", _fast(lambda at: lambda _: at), "too fast"),
    silent("the same, its clock runs back", _fast(lambda at: lambda t: 2 * at - t), "too fast"),
    anywhere(silent("a modulus that is no number", _modulus, "nan")),
    anywhere(silent("the body is replaced", _other_body, "ramping: body replaced")),
    anywhere(silent("no tick for 21 ms to 2 s", _gap, "suspended")),
    Cause("unplugged, plugged in again", _unplug, Outcome.SILENT, "unplugged", line_gone=True),
    silent("another protocol", _other_protocol, "wrong protocol"),
    silent("a HELLO that cannot be", _unsound_hello, "waiting: no sound answer to HELLO yet"),
    silent("a HELLO with other figures", _other_figures, "waiting: no STATE yet"),
    silent("the device was reset in a silence", _reset, "stale", STALE_TICKS),
    anywhere(Cause("10 to 1,000,000 times as stiff", _stiffer, Outcome.LIMITED, named="clamp")),
)
