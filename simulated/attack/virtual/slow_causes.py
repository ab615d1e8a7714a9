"""Devices that do not read, lines that are slow, and what of old forces they hand over."""

from __future__ import annotations

import math
from dataclasses import replace
from random import Random

from ....core.servo import link
from .cause import STALE_TICKS, Cause, Inject, Outcome
from .shot import Shot
from .virtual_press import VirtualPress

FORCE_BITS = 230
"""Of the longest FORCE, and the zero before it, with a start and a stop bit each."""
DEAF_MS = (21.0, 3000.0)
OFF_TICKS = 80
LAG_SECONDS = (0.025, 0.3)
LAG_TICKS = 400


def _deaf(press: VirtualPress, dice: Random) -> list[Shot]:
    """It reads nothing for 21 ms to 3 s; then it has what the driver kept."""
    least, most = map(math.log, DEAF_MS)
    press.deaf = True
    shots = [press.tick() for _ in range(round(math.exp(dice.uniform(least, most))))]
    press.deaf = False
    return [*shots, press.tick()]


def _slow(baud: int) -> Inject:
    """Behind a line of this speed the user switches off."""

    def inject(press: VirtualPress, dice: Random) -> list[Shot]:
        press.baud = baud
        for _ in range(dice.randint(200, 300)):
            press.tick()
        press.servo.set(replace(press.settings, enabled=False))
        shots = [press.tick() for _ in range(OFF_TICKS)]
        press.baud = None
        press.servo.set(press.settings)
        return shots

    return inject


def _lagging(press: VirtualPress, dice: Random) -> list[Shot]:
    """All of STATE comes so much too late, and always the same; then it goes into the body."""
    lag = dice.uniform(*LAG_SECONDS)
    press.arrival = lambda time: time + lag
    shots = [press.tick() for _ in range(LAG_TICKS)]
    return [*shots, *press.glide(press.target.deep), *(press.tick() for _ in range(LAG_TICKS))]


def _slow_cause(baud: int) -> Cause:
    # What is on its way goes on; then zero.
    ticks = 1 + math.ceil(2.0 * FORCE_BITS / baud * 1e3)
    name = f"switched off behind {baud} baud"
    told = "disabled: switched off"
    return Cause(name, _slow(baud), Outcome.SILENT, told, felt_within=ticks)


SLOW_CAUSES = (
    Cause(
        "the device reads nothing for 21 ms to 3 s",
        _deaf,
        Outcome.SILENT,
        "",
        STALE_TICKS + 1,
        True,
    ),
    *(_slow_cause(baud) for baud in (19_200, 57_600, 115_200, 1_000_000)),
    Cause("STATE 25 to 300 ms old", _lagging, Outcome.UNFELT, protocols=(link.PROTOCOL,)),
)
