"""Jumps and flags that a line or a clock hides, close above a body and in it.

The device's own story is always the same: for some ticks it stands 5 mm above the body, and then
its encoder is somewhere else, 5 to 40 mm inwards. Each cause differs in what makes that look
harmless. No step is one that a hand could make: it is at least twice the largest speed (2 m/s).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from random import Random

import numpy as np

from ....core.servo import link
from ...hand.quaternion import UPRIGHT, Quaternion, about
from .cause import Inject, anywhere, silent, unfelt
from .line_causes import hold_upright, without_orientation
from .shot import Shot
from .virtual_press import Place, VirtualPress, flagged

SMALLEST, LARGEST = 0.005, 0.040
"""Of jumps, m."""
NO_HAND = 4.0
"""Faster than any hand, m/s."""
BEFORE = (0.005, 0.025)
AFTER_TICKS = 160
"""Longer than a device must be still after it was too fast."""
MOST_IN_A_BURST = 16
RATES = (1000, 1000, 2000, 4000)

Clock = Callable[[float], float]


def _inwards(press: VirtualPress, dice: Random, least: float = SMALLEST) -> Place:
    """A jump, at most 30 degrees off the way in."""
    aside = np.array([dice.gauss(0.0, 1.0) for _ in range(3)])
    aside -= aside @ press.target.inward * press.target.inward
    aside *= dice.uniform(0.0, 0.58) / float(np.linalg.norm(aside))
    way = press.target.inward + aside
    return np.asarray(dice.uniform(least, LARGEST) / np.linalg.norm(way) * way)


def _jumping(press: VirtualPress, jumps: list[tuple[float, Place]]) -> Callable[[float], Place]:
    start = press.position.copy()
    return lambda time: start + sum((by for at, by in jumps if time >= at), np.zeros(3))


def play(press: VirtualPress, ticks: int = AFTER_TICKS) -> list[Shot]:
    """Some ticks of what was prepared; then path, line and clock go on as usual."""
    shots = [press.tick() for _ in range(ticks)]
    ahead = press.clock(press.now) - press.now
    press.clock = lambda time: time + ahead
    press.path, press.arrival = None, float
    return shots


def _soon(press: VirtualPress, dice: Random) -> float:
    return press.now + dice.uniform(*BEFORE)


def _held_back(press: VirtualPress, dice: Random, at: float) -> Clock:
    """A line that hands over 2 to 16 STATE together, that of time `at` among them."""
    length = dice.randint(2, MOST_IN_A_BURST) / press.rate_hz
    end = at + dice.uniform(0.0, length)
    return lambda time: end if end - length <= time <= end else time


def _jittering(dice: Random) -> Clock:
    most = dice.uniform(0.0005, 0.005)
    return lambda time: time + dice.uniform(0.0, most)


def _leaping(dice: Random, at: float) -> Clock:
    leap = dice.uniform(0.005, 0.1)
    return lambda time: time + leap * (time >= at)


def _drifting(dice: Random, at: float) -> Clock:
    """From shortly before the jump on it goes 1.5 to 20 times as fast."""
    start, pace = at - BEFORE[0], dice.uniform(1.5, 20.0)
    return lambda time: time if time < start else start + pace * (time - start)


def _halting(dice: Random, at: float) -> Clock:
    """It stands or runs backwards, shortly before the jump or with it."""
    begin, pace = at - dice.uniform(0.0, 0.003), dice.choice([0.0, -1.0])
    return lambda time: time if time < begin else begin + pace * (time - begin)


def _jump(
    *,
    burst: bool = False,
    jitter: bool = False,
    clock: Callable[[Random, float], Clock] | None = None,
    parts: tuple[int, int] = (1, 1),
) -> Inject:
    def inject(press: VirtualPress, dice: Random) -> list[Shot]:
        at = _soon(press, dice)
        count = dice.randint(*parts)
        jumps = [
            (
                at + part * dice.randint(1, 3) / press.rate_hz,
                _inwards(press, dice, count * SMALLEST) / count,
            )
            for part in range(count)
        ]
        press.path = _jumping(press, jumps)
        if clock is not None:
            press.clock = clock(dice, at)
        if burst:
            press.arrival = _held_back(press, dice, at)
        elif jitter:
            press.arrival = _jittering(dice)
        return play(press)

    return inject


def _after_loss(press: VirtualPress, dice: Random) -> list[Shot]:
    lost = dice.randint(1, 8)
    least = max(SMALLEST, NO_HAND * (lost + 1) / press.rate_hz)
    press.path = _jumping(press, [(press.now, _inwards(press, dice, least))])
    return [*(press.tick(lambda _: b"") for _ in range(lost)), *play(press)]


def _after_being_held_up(press: VirtualPress, dice: Random) -> list[Shot]:
    """The host misses some ticks, and finds several STATE."""
    seconds = dice.randint(2, 8) / press.rate_hz
    by = _inwards(press, dice, SMALLEST)
    press.path = _jumping(press, [(press.now + dice.uniform(0.0, seconds), by)])
    return [press.tick(seconds=seconds), *play(press)]


def _with_a_session(press: VirtualPress, dice: Random) -> list[Shot]:
    figures = replace(press.device.hello, largest_force=dice.uniform(5.0, 50.0))
    press.path = _jumping(press, [(press.now, _inwards(press, dice))])
    return [press.tick(lambda sent: link.encode(figures) + sent), *play(press)]


def _with_the_plug(press: VirtualPress, dice: Random) -> list[Shot]:
    press.servo.unplug()
    shots = [press.tick(lambda _: b"") for _ in range(dice.randint(1, 50))]
    press.path = _jumping(press, [(press.now, _inwards(press, dice))])
    press.servo.plug_in()
    press.device.plug_in()
    return shots + play(press, 2 * AFTER_TICKS)


def _with_flipped_bits(press: VirtualPress, dice: Random) -> list[Shot]:
    """No checksum finds them; nothing moves."""

    def flipped(sent: bytes) -> bytes:
        damaged = bytearray(sent)
        if damaged and dice.random() < 0.2:
            damaged[dice.randrange(len(damaged))] ^= 1 << dice.randrange(8)
        return bytes(damaged)

    return [press.tick(flipped) for _ in range(AFTER_TICKS)]


def _without_turn(press: VirtualPress, dice: Random) -> list[Shot]:
    """ORIENTATION is lost, and the place jumps meanwhile or when it is back."""
    hold_upright(press)
    press.hover()
    lost = dice.randint(1, 18)
    at = press.now + dice.randint(0, lost) / press.rate_hz
    press.path = _jumping(press, [(at, _inwards(press, dice))])
    return [*(press.tick(without_orientation) for _ in range(lost)), *play(press)]


def _in_a_burst(alter: Callable[[link.State, Random], link.State], turned: bool = False) -> Inject:
    """One of several STATE that come together is bad, and the last one never is."""

    def inject(press: VirtualPress, dice: Random) -> list[Shot]:
        count = dice.randint(2, 15)
        bad = dice.randrange(count - 1)
        held = b""

        def keep(sent: bytes) -> bytes:
            nonlocal held
            held += sent
            return b""

        def turn_once(number: int) -> Quaternion | None:
            if not turned:
                return press.turned
            axis = (dice.gauss(0.0, 1.0), dice.gauss(0.0, 1.0), dice.gauss(0.0, 1.0))
            return about(axis, dice.uniform(0.3, 3.1)) if number == bad else UPRIGHT

        if turned:
            hold_upright(press)
        for number in range(count):
            press.altered = (lambda state: alter(state, dice)) if number == bad else None
            press.turned = turn_once(number)
            shot = press.tick(keep if number < count - 1 else lambda sent: held + sent)
        press.altered = None
        return [shot, press.tick()]

    return inject


def _far(state: link.State, dice: Random) -> link.State:
    most = (1 << 31) - 1
    place = (dice.randint(-most, most), dice.randint(-most, most), dice.randint(-most, most))
    return replace(state, position_um=place)


def _flagged(flags: link.StateFlag) -> Inject:
    return _in_a_burst(lambda state, _: flagged(state, flags))


HIDDEN_CAUSES = (
    anywhere(unfelt("jump, plain", _jump(), *RATES)),
    anywhere(unfelt("jump in a burst of 2 to 16 STATE", _jump(burst=True), *RATES)),
    anywhere(unfelt("jump on a line with jitter", _jump(jitter=True), *RATES)),
    unfelt("jump, its clock leaps 5 to 100 ms", _jump(clock=_leaping), *RATES),
    unfelt(
        "jump in a burst, its clock leaps",
        _jump(burst=True, clock=_leaping),
        *RATES,
    ),
    unfelt("jump, its clock stands or runs back", _jump(clock=_halting), *RATES),
    unfelt(
        "jump, its clock 1.5 to 20 times as fast",
        _jump(clock=_drifting),
        *RATES,
    ),
    unfelt("jump in 2 to 4 parts", _jump(parts=(2, 4)), *RATES),
    anywhere(unfelt("jump after 1 to 8 lost STATE", _after_loss)),
    anywhere(unfelt("jump while the host is held up", _after_being_held_up)),
    unfelt("jump with another session", _with_a_session),
    unfelt("jump with the plug pulled and put back", _with_the_plug),
    unfelt("jump while ORIENTATION is lost", _without_turn),
    anywhere(unfelt("bits flipped close above the body", _with_flipped_bits)),
    silent("a far place in a burst", _in_a_burst(_far), "too fast"),
    silent("a turn in a burst", _in_a_burst(lambda state, _: state, turned=True), "too fast"),
    silent(
        "a fault flag in a burst",
        _flagged(link.StateFlag.READY | link.StateFlag.FAULT),
        "device fault",
    ),
    silent("not ready in a burst", _flagged(link.StateFlag(0)), "waiting: the device is not ready"),
    silent(
        "a button in a burst",
        _in_a_burst(lambda state, dice: replace(state, buttons=1 << dice.randrange(8))),
        "disabled: device button",
    ),
)
