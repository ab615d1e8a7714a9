"""A line that goes wrong in the middle of a press, and the orientation that it carries."""

from __future__ import annotations

import math
from dataclasses import replace
from random import Random

from ....core.servo import link
from ...hand.quaternion import UPRIGHT, about
from .cause import STALE_TICKS, Inject, anywhere, harmless, silent
from .shot import Shot
from .virtual_press import VirtualPress, state_in


def mute(press: VirtualPress, dice: Random) -> list[Shot]:
    """Let nothing come for more than 20 ms."""
    return [press.tick(lambda _: b"") for _ in range(STALE_TICKS + dice.randint(1, 100))]


def _damaged_for_long(press: VirtualPress, dice: Random) -> list[Shot]:
    """Every STATE with a flipped bit: none of them counts as heard."""
    return [press.tick(lambda sent: _flipped(sent, dice)) for _ in range(STALE_TICKS + 10)]


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


def hold_upright(press: VirtualPress) -> None:
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


def without_orientation(sent: bytes) -> bytes:
    """Keep only the STATE."""
    return link.encode(state_in(sent))


def _untold(press: VirtualPress, dice: Random) -> list[Shot]:
    hold_upright(press)
    ticks = STALE_TICKS + dice.randint(1, 100)
    return [press.tick(without_orientation) for _ in range(ticks)]


def _twist(press: VirtualPress, dice: Random) -> list[Shot]:
    """From one tick to the next, about any axis."""
    hold_upright(press)
    axis = (dice.gauss(0.0, 1.0), dice.gauss(0.0, 1.0), dice.gauss(0.0, 1.0))
    press.turned = about(axis, math.radians(dice.uniform(4.0, 180.0)))
    shots = [press.tick() for _ in range(dice.randint(1, 150))]
    press.turned = UPRIGHT
    return [*shots, press.tick()]


def _lose_orientation(press: VirtualPress, dice: Random) -> list[Shot]:
    hold_upright(press)
    return [press.tick(without_orientation) for _ in range(dice.randint(1, 15))]


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

        hold_upright(press)
        return [press.tick(in_its_place)]

    return inject


def _noise(press: VirtualPress, dice: Random) -> list[Shot]:
    junk = bytes(dice.randrange(1, 256) for _ in range(dice.randint(62, 1500))) + b"\0"
    return [press.tick(lambda sent: junk + sent)]


def _unknown(press: VirtualPress, dice: Random) -> list[Shot]:
    junk = link.frame(bytes([dice.randint(6, 255)]) + dice.randbytes(dice.randint(0, 50)))
    return [press.tick(lambda sent: junk + sent)]


LINE_CAUSES = (
    anywhere(silent("no STATE for more than 20 ms", mute, "stale", STALE_TICKS)),
    silent("only damaged STATE", _damaged_for_long, "stale", STALE_TICKS),
    silent("its first ORIENTATION in mid-press", _begin_to_tell, "waiting: no STATE yet"),
    silent("turned by 4 to 180 degrees at once", _twist, "too fast"),
    silent("no ORIENTATION for 20 ms", _untold, "stale", STALE_TICKS),
    harmless("one bit flipped", _flip, "damaged"),
    harmless("1 to 15 STATE lost", _lose, "lost"),
    harmless("a STATE twice", _elsewhere(is_older=False), "duplicates"),
    harmless("an old STATE after a newer one", _elsewhere(is_older=True), "out_of_order"),
    harmless("1 to 15 ORIENTATION lost", _lose_orientation, "orientations_lost"),
    harmless(
        "an ORIENTATION of another STATE",
        _another_orientation(of_another_state=True),
        "orientations_unpaired",
    ),
    harmless(
        "an ORIENTATION that is none",
        _another_orientation(of_another_state=False),
        "orientations_refused",
    ),
    harmless("62 to 1,500 bytes of noise", _noise, "damaged"),
    harmless("a message of unknown type", _unknown, "unknown"),
)
