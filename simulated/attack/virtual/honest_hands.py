"""Honest hands on bad lines: whoever finds jumps must not take these for one."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import numpy as np

from .cause import Cause, Inject, Outcome, anywhere
from .hidden_causes import RATES, play
from .shot import Shot
from .virtual_press import VirtualPress

TICKS = 300
FASTEST = 1.0
"""m/s: what docs/safety.md promises to let pass in a burst."""
QUICKEST = 38.0
"""To and fro, rad/s: 6 Hz, and 29 m/s^2 with the rest."""
AT_ONCE = 0.75
"""m/s: what docs/safety.md promises to a hand that sets out from one moment to the next."""
STROKE = 0.03
"""m, when it sets out."""
MOST_LOST = 15
LEAST_HEARD = 3
"""Ticks: a 2DIY that waits for four answers in vain is asked again after 5 ms."""
MOST_HELD_UP = 15

Line = Callable[[float], float]


def _moving(press: VirtualPress, dice: Random) -> None:
    """The hand goes off the body and back, on and on."""
    start, begun = press.position.copy(), press.now
    turns = dice.uniform(3.0, QUICKEST)
    half = min(FASTEST / turns, dice.uniform(0.005, 0.02))

    def path(time: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
        away = half * (1.0 - np.cos(turns * (time - begun)))
        return np.asarray(start - away * press.target.inward)

    press.path = path


def _hand(arrival: Callable[[Random], Line] | None = None, *, is_fast: bool = False) -> Inject:
    def inject(press: VirtualPress, dice: Random) -> list[Shot]:
        _moving(press, dice)
        if arrival is not None:
            press.arrival = arrival(dice)
        if is_fast:
            start, pace = press.now, dice.uniform(0.9, 1.1)
            press.clock = lambda time: start + pace * (time - start)
        return play(press, TICKS)

    return inject


def _jitter(dice: Random) -> Line:
    return lambda time: time + dice.uniform(0.0, 0.003)


def _latency_timer(_: Random) -> Line:
    return lambda time: float(np.ceil(time / 0.016) * 0.016)


def _losses(press: VirtualPress, dice: Random) -> list[Shot]:
    _moving(press, dice)
    shots: list[Shot] = []
    while len(shots) < TICKS:
        shots += [press.tick(lambda _: b"") for _ in range(dice.randint(1, MOST_LOST))]
        shots += [press.tick() for _ in range(dice.randint(LEAST_HEARD, 30))]
    return [*shots, *play(press, 1)]


def _setting_out(press: VirtualPress, dice: Random) -> list[Shot]:
    """It stands, and goes off the body at once; on a good line or a bad one."""
    start, begun = press.position.copy(), press.now + dice.uniform(0.01, 0.03)
    speed = dice.uniform(0.3, AT_ONCE)

    def path(time: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
        away = min(STROKE, speed * max(0.0, time - begun))
        return np.asarray(start - away * press.target.inward)

    press.path = path
    press.arrival = dice.choice([float, _jitter(dice), _latency_timer(dice)])
    return play(press, TICKS // 2)


def _held_up(press: VirtualPress, dice: Random) -> list[Shot]:
    _moving(press, dice)
    shots: list[Shot] = []
    while len(shots) < TICKS:
        shots.append(press.tick(seconds=dice.randint(2, MOST_HELD_UP) * 1e-3))
        shots += [press.tick() for _ in range(dice.randint(1, 30))]
    return [*shots, *play(press, 1)]


def _unnoticed(name: str, inject: Inject, *rates: int) -> Cause:
    return anywhere(Cause(name, inject, Outcome.UNNOTICED, rates=rates or (1000,)))


HONEST_HANDS = (
    _unnoticed("an honest hand", _hand(), *RATES),
    _unnoticed("an honest hand that sets out at once", _setting_out, *RATES),
    _unnoticed("an honest hand, jitter of 3 ms", _hand(_jitter), *RATES),
    _unnoticed("an honest hand, latency timer of 16 ms", _hand(_latency_timer)),
    _unnoticed("an honest hand, its clock 10 % wrong", _hand(is_fast=True), *RATES),
    _unnoticed("an honest hand, 1 to 15 STATE lost", _losses),
    _unnoticed("an honest hand, the host held up 2 to 15 ms", _held_up),
)
