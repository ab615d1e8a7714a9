"""What can go wrong in the middle of a press, and what must come of it (docs/safety.md)."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from random import Random

import numpy as np

from palpate.core.servo import link
from palpate.core.servo.settings import Settings
from palpate.simulated.hand.quaternion import UPRIGHT, about

from .servo_host import ABOVE, YOUNG_MODULUS, cube
from .virtual_press import Shot, VirtualPress, state_in

STALE_TICKS = 21
"""20 ms without STATE, and the tick that finds it."""


class Outcome(Enum):
    """What a cause must lead to."""

    SILENT = "zero"
    """Zero force, named, and a ramp afterwards."""
    HARMLESS = "none"
    """No change of the force at all."""
    LIMITED = "limited"
    """Force, but no more than a limit."""


Inject = Callable[[VirtualPress, Random], list[Shot]]


@dataclass(frozen=True)
class Cause:
    """How something is brought about in the middle of a press, and the rule for it."""

    name: str
    inject: Inject
    outcome: Outcome
    named: str = ""
    """The fault or state that the user must read."""
    zero_within: int = 0
    """Ticks from the cause to zero force; 0 is the same tick."""
    line_gone: bool = False
    """Nothing reaches the device any more: its own watchdog must do."""
    counter: str = ""
    """Counter of the link that must rise."""


def _hold(press: VirtualPress, dice: Random, **changed: object) -> list[Shot]:
    """Some ticks with attributes of the press changed."""
    before = {name: getattr(press, name) for name in changed}
    for name, value in changed.items():
        setattr(press, name, value)
    shots = [press.tick() for _ in range(dice.randint(1, 60))]
    for name, value in before.items():
        setattr(press, name, value)
    return shots


def _button(press: VirtualPress, dice: Random) -> list[Shot]:
    return _hold(press, dice, buttons=1 << dice.randrange(8))


def _not_ready(press: VirtualPress, dice: Random) -> list[Shot]:
    return _hold(press, dice, flags=link.StateFlag(0))


def _fault_flag(press: VirtualPress, dice: Random) -> list[Shot]:
    return _hold(press, dice, flags=link.StateFlag.READY | link.StateFlag.FAULT)


def _fault_message(press: VirtualPress, dice: Random) -> list[Shot]:
    told = link.encode(link.Fault(dice.randint(128, 255), dice.randrange(1 << 16)))
    return [press.tick(lambda sent: told + sent)]


def _switch(press: VirtualPress, dice: Random) -> list[Shot]:
    press.servo.set(Settings(YOUNG_MODULUS, enabled=False))
    shots = [press.tick() for _ in range(dice.randint(1, 60))]
    press.servo.set(Settings(YOUNG_MODULUS))
    return shots


def _jump(press: VirtualPress, dice: Random) -> list[Shot]:
    """An encoder that loses its place by half a metre to two thousand."""
    where = np.array([dice.gauss(0, 1) for _ in range(3)])
    press.position = where / np.linalg.norm(where) * 10 ** dice.uniform(-0.3, 3.3)
    shots = [press.tick() for _ in range(dice.randint(1, 150))]
    press.position = np.array(ABOVE)
    return [*shots, press.tick()]


def _fast(clock: Callable[[float], Callable[[float], float]]) -> Inject:
    """At 3 to 8 m/s out of the body, by a clock that is wrong since the tick before."""

    def inject(press: VirtualPress, dice: Random) -> list[Shot]:
        press.device.clock = clock(press.now)
        press.tick()
        step = dice.uniform(3e-3, 8e-3)
        shots = []
        for _ in range(5):
            press.position = press.position + np.array([0.0, 0.0, step])
            shots.append(press.tick())
        press.device.clock = float
        press.position = np.array(ABOVE)
        return shots

    return inject


def _modulus(press: VirtualPress, dice: Random) -> list[Shot]:
    press.servo.set(Settings(dice.choice([math.nan, math.inf, -math.inf, -1.0, 0.0])))
    shots = [press.tick() for _ in range(dice.randint(1, 20))]
    press.servo.set(Settings(YOUNG_MODULUS))
    return shots


def _other_body(press: VirtualPress, dice: Random) -> list[Shot]:
    press.servo.set_body(cube(dice.uniform(0.045, 0.05)), Settings(YOUNG_MODULUS))
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


def _mute(press: VirtualPress, dice: Random) -> list[Shot]:
    return [press.tick(lambda _: b"") for _ in range(STALE_TICKS + dice.randint(1, 100))]


def _damaged_for_long(press: VirtualPress, dice: Random) -> list[Shot]:
    """Every STATE with a flipped bit: none of them counts as heard."""
    return [press.tick(lambda sent: _flipped(sent, dice)) for _ in range(STALE_TICKS + 10)]


def _other_protocol(press: VirtualPress, dice: Random) -> list[Shot]:
    hello = link.frame(bytes([1, dice.randint(3, 255)]))
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
    shots = _mute(press, dice)
    begun = press.now
    press.device.clock = lambda time: time - begun
    press.position = press.position - np.array([0.0, 0.0, dice.uniform(0.001, 0.03)])
    return shots


def _flipped(frame: bytes, dice: Random) -> bytes:
    """One bit wrong, and no frame more or less for it."""
    damaged = bytearray(frame)
    while True:
        at, bit = dice.randrange(max(1, len(frame) - 1)), 1 << dice.randrange(8)
        if damaged[at] != bit:
            damaged[at] ^= bit
            return bytes(damaged)


def _flip(press: VirtualPress, dice: Random) -> list[Shot]:
    return [press.tick(lambda sent: _flipped(sent, dice))]


def _lose(press: VirtualPress, dice: Random) -> list[Shot]:
    return [press.tick(lambda _: b"") for _ in range(dice.randint(1, 15))]


def _elsewhere(*, is_older: bool) -> Inject:
    """A STATE of a used number from a place metres away: to use it would be noticed at once."""

    def inject(press: VirtualPress, dice: Random) -> list[Shot]:
        def with_old(sent: bytes) -> bytes:
            state = state_in(sent)
            back = dice.randint(1, 30_000) if is_older else 0
            number = (state.sequence - back) % link.SEQUENCES
            far = replace(state, sequence=number, position_um=(5_000_000, 0, 0))
            return sent + link.encode(far)

        return [press.tick(with_old)]

    return inject


def _hold_upright(press: VirtualPress) -> None:
    """Make it a device that tells how it is turned, if it is none yet."""
    if press.turned is None:
        press.turned = UPRIGHT
        press.press()


def _begin_to_tell(press: VirtualPress, dice: Random) -> list[Shot]:
    """A device that was taken for upright turns out to be turned otherwise."""
    press.turned = None
    press.servo.unplug()
    press.tick(lambda _: b"")
    press.servo.plug_in()
    press.device.plug_in()
    press.press()
    press.turned = about((0.0, 1.0, 0.0), dice.uniform(-3.0, 3.0))
    return [press.tick()]


def _without_orientation(sent: bytes) -> bytes:
    return link.encode(state_in(sent))


def _untold(press: VirtualPress, dice: Random) -> list[Shot]:
    _hold_upright(press)
    ticks = STALE_TICKS + dice.randint(1, 100)
    return [press.tick(_without_orientation) for _ in range(ticks)]


def _twist(press: VirtualPress, dice: Random) -> list[Shot]:
    """From one tick to the next, about any axis."""
    _hold_upright(press)
    axis = (dice.gauss(0.0, 1.0), dice.gauss(0.0, 1.0), dice.gauss(0.0, 1.0))
    press.turned = about(axis, math.radians(dice.uniform(4.0, 180.0)))
    shots = [press.tick() for _ in range(dice.randint(1, 150))]
    press.turned = UPRIGHT
    return [*shots, press.tick()]


def _lose_orientation(press: VirtualPress, dice: Random) -> list[Shot]:
    _hold_upright(press)
    return [press.tick(_without_orientation) for _ in range(dice.randint(1, 15))]


def _another_orientation(*, of_another_state: bool) -> Inject:
    """A rotation of another STATE, or for this one what is none; to use it would be `too fast`."""

    def inject(press: VirtualPress, dice: Random) -> list[Shot]:
        def in_its_place(sent: bytes) -> bytes:
            state = state_in(sent)
            wrong = link.Orientation(state.sequence, (0, dice.randint(0, 32_439), 0, 0))
            if of_another_state:
                number = (state.sequence + dice.randint(1, link.SEQUENCES - 1)) % link.SEQUENCES
                wrong = link.Orientation(number, (0, 32_767, 0, 0))
            return link.encode(wrong) + link.encode(state)

        _hold_upright(press)
        return [press.tick(in_its_place)]

    return inject


def _noise(press: VirtualPress, dice: Random) -> list[Shot]:
    junk = bytes(dice.randrange(1, 256) for _ in range(dice.randint(62, 1500))) + b"\0"
    return [press.tick(lambda sent: junk + sent)]


def _unknown(press: VirtualPress, dice: Random) -> list[Shot]:
    junk = link.frame(bytes([dice.randint(6, 255)]) + dice.randbytes(dice.randint(0, 50)))
    return [press.tick(lambda sent: junk + sent)]


def _stiffer(press: VirtualPress, dice: Random) -> list[Shot]:
    press.servo.set(Settings(YOUNG_MODULUS * dice.uniform(10, 1e6)))
    shots = [press.tick() for _ in range(60)]
    press.servo.set(Settings(YOUNG_MODULUS))
    return shots


def _silent(name: str, inject: Inject, named: str, within: int = 0) -> Cause:
    return Cause(name, inject, Outcome.SILENT, named, within)


def _harmless(name: str, inject: Inject, counter: str) -> Cause:
    return Cause(name, inject, Outcome.HARMLESS, counter=counter)


CAUSES = (
    _silent("the device's button is held", _button, "disabled: device button"),
    _silent("switched off by the user", _switch, "disabled: switched off"),
    _silent("the device is not ready", _not_ready, "waiting: the device is not ready"),
    _silent("the device's fault flag", _fault_flag, "device fault"),
    _silent("a FAULT of the device", _fault_message, "device fault"),
    _silent("the encoder loses its place", _jump, "too fast"),
    _silent("faster than 2 m/s", _fast(lambda _: float), "too fast"),
    _silent("the same, its clock stands", _fast(lambda at: lambda _: at), "too fast"),
    _silent("the same, its clock runs back", _fast(lambda at: lambda t: 2 * at - t), "too fast"),
    _silent("a modulus that is no number", _modulus, "nan"),
    _silent("the body is replaced", _other_body, "ramping: body replaced"),
    _silent("no tick for 21 ms to 2 s", _gap, "suspended"),
    Cause("unplugged, plugged in again", _unplug, Outcome.SILENT, "unplugged", line_gone=True),
    _silent("another protocol", _other_protocol, "wrong protocol"),
    _silent("a HELLO that cannot be", _unsound_hello, "waiting: no sound answer to HELLO yet"),
    _silent("a HELLO with other figures", _other_figures, "waiting: no STATE yet"),
    _silent("the device was reset in a silence", _reset, "stale", STALE_TICKS),
    _silent("no STATE for more than 20 ms", _mute, "stale", STALE_TICKS),
    _silent("only damaged STATE", _damaged_for_long, "stale", STALE_TICKS),
    _silent("its first ORIENTATION in mid-press", _begin_to_tell, "waiting: no STATE yet"),
    _silent("turned by 4 to 180 degrees at once", _twist, "too fast"),
    _silent("no ORIENTATION for 20 ms", _untold, "stale", STALE_TICKS),
    _harmless("one bit flipped", _flip, "damaged"),
    _harmless("1 to 15 STATE lost", _lose, "lost"),
    _harmless("a STATE twice", _elsewhere(is_older=False), "duplicates"),
    _harmless("an old STATE after a newer one", _elsewhere(is_older=True), "out_of_order"),
    _harmless("1 to 15 ORIENTATION lost", _lose_orientation, "orientations_lost"),
    _harmless(
        "an ORIENTATION of another STATE",
        _another_orientation(of_another_state=True),
        "orientations_unpaired",
    ),
    _harmless(
        "an ORIENTATION that is none",
        _another_orientation(of_another_state=False),
        "orientations_refused",
    ),
    _harmless("62 to 1,500 bytes of noise", _noise, "damaged"),
    _harmless("a message of unknown type", _unknown, "unknown"),
    Cause("10 to 1,000,000 times as stiff", _stiffer, Outcome.LIMITED, named="clamp"),
)
