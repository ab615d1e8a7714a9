"""What can go wrong while a body is touched, and what must come of it (docs/safety.md)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from random import Random

from ....core.servo import link
from .shot import Shot
from .virtual_press import VirtualPress

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
    UNFELT = "unfelt"
    """Close above the body nothing is felt, wherever the device says to be then."""
    UNNOTICED = "unnoticed"
    """Nothing happens to the device of an honest hand: no fault."""


Inject = Callable[[VirtualPress, Random], list[Shot]]


@dataclass(frozen=True)
class Cause:
    """How something is brought about in the middle of a press, and the rule for it."""

    name: str
    inject: Inject
    outcome: Outcome
    named: str = ""
    """The fault or state that the user must read; empty where it may be one of several."""
    zero_within: int = 0
    """Ticks from the cause to zero force; 0 is the same tick."""
    line_gone: bool = False
    """Nothing reaches the device any more: its own watchdog must do."""
    counter: str = ""
    """Counter of the link that must rise."""
    felt_within: int = 1
    """Ticks from zero force to the motors' zero: what the line takes."""
    protocols: tuple[int, ...] = (link.FIRST_PROTOCOL, link.PROTOCOL)
    """Those in which it can be found."""
    rates: tuple[int, ...] = (1000,)
    """STATE a second of the devices that do this."""
    anywhere: bool = False
    """It needs no message of the link: a Haply 2DIY does it too."""


def silent(name: str, inject: Inject, named: str, within: int = 0) -> Cause:
    """What must end the force within so many ticks, and be named."""
    return Cause(name, inject, Outcome.SILENT, named, within)


def harmless(name: str, inject: Inject, counter: str) -> Cause:
    """What must be counted, and change nothing."""
    return Cause(name, inject, Outcome.HARMLESS, counter=counter)


def unfelt(name: str, inject: Inject, *rates: int) -> Cause:
    """What must not be felt close above a body."""
    return Cause(name, inject, Outcome.UNFELT, rates=rates or (1000,))


def anywhere(cause: Cause) -> Cause:
    """What needs no message of the link."""
    return replace(cause, anywhere=True)


def held(press: VirtualPress, ticks: int, **changed: object) -> list[Shot]:
    """Some ticks with attributes of the press changed."""
    before = {name: getattr(press, name) for name in changed}
    for name, value in changed.items():
        setattr(press, name, value)
    shots = [press.tick() for _ in range(ticks)]
    for name, value in before.items():
        setattr(press, name, value)
    return shots
