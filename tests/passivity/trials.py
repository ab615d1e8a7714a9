"""Whether a touch is passive, whoever holds the device: the hands and presses it is tried with."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

from .contact_loop import CouplingSettings, DevicePlant, PassiveHand, Press, press

MOST_EXTRACTED = 1e-6
"""Energy (J) that the motor may give beyond what friction takes: a hundredth of a key press's."""

MOST_HUM = 1e-7
"""Energy (J) that may still be made in the last half second without getting less and less."""

DYING = 0.9
"""What is made in the last half second over what was in the one before, when it gets less."""

PUSHES = (0.05, 0.3, 1.0, 2.5)
"""Hands without any spring or damper: the weight of a finger, N."""

GRIPS = (30.0, 200.0, 1000.0)
"""Springs of hands, N/m: from two fingertips to a firm grip."""

GRIP_FORCES = (0.2, 1.5)
"""What they come to rest with, N."""

RELAXATION = 0.004
"""Damping over stiffness of hands, s: the least of what is measured (Hajian and Howe 1997)."""

SPEEDS = (0.01, 0.1, 0.25)
"""Of the first touch, m/s."""


@dataclass(frozen=True)
class Verdict:
    """The worst of all trials."""

    extracted: float
    """J beyond what friction took."""
    hum: float
    """J made in the last quarter of a trial, if it was not on the way to silence."""
    hand: PassiveHand
    how: Press

    @property
    def passive(self) -> bool:
        """Nothing to be got out of it, and silence in the end."""
        return self.excess <= 1.0

    @property
    def excess(self) -> float:
        """Energies over what is allowed."""
        return max(self.extracted / MOST_EXTRACTED, self.hum / MOST_HUM)


def hands(seen_stiffness: float) -> Iterator[PassiveHand]:
    """Every hand that is tried; nobody at all is the first.

    seen_stiffness : N/m, that of the body as the device at rest sees it.
    """
    yield PassiveHand()
    for push in PUSHES:
        yield PassiveHand(push=push)
    for stiffness in GRIPS:
        for force in GRIP_FORCES:
            yield PassiveHand.gripping(stiffness, RELAXATION, force, seen_stiffness)


def judge(
    plant: DevicePlant,
    body_stiffness: float,
    coupling: CouplingSettings,
    *,
    first_failure: bool = False,
    seconds: float = 2.0,
) -> Verdict:
    """Press with every hand at every speed, from outside; the worst that came of it.

    With ``first_failure`` the first trial that is not passive ends the search.
    """
    worst: Verdict | None = None
    for hand, speed in itertools.product(hands(coupling.seen_stiffness(body_stiffness)), SPEEDS):
        how = Press(speed=speed, seconds=seconds)
        outcome = press(plant, hand, body_stiffness, coupling, how)
        late = outcome["made_late"]
        hum = late if late > DYING * outcome["made_before"] else 0.0
        found = Verdict(outcome["extracted"], hum, hand, how)
        if worst is None or found.excess > worst.excess:
            worst = found
        if first_failure and not worst.passive:
            break
    if worst is None:
        raise RuntimeError("there is no hand to try")
    return worst


def is_passive(plant: DevicePlant, body_stiffness: float, coupling: CouplingSettings) -> bool:
    """Whether `judge` finds nothing."""
    return judge(plant, body_stiffness, coupling, first_failure=True).passive


def stiffest_passive_body(
    plant: DevicePlant,
    coupling: CouplingSettings,
    *,
    least: float = 50.0,
    most: float = 20_000.0,
    steps: int = 13,
    halvings: int = 3,
) -> float:
    """The stiffness (N/m) up to which every body is passive: 0 if none is, `most` if all are.

    Goes up in `steps` equal factors to the first body that is not, then halves the last factor.
    """
    factor = (most / least) ** (1.0 / steps)
    passive, stiffness = 0.0, least
    for step in range(steps + 1):
        stiffness = least * factor**step
        if not is_passive(plant, stiffness, coupling):
            break
        passive = stiffness
    if passive in (0.0, stiffness):
        return passive
    for _ in range(halvings):
        middle = (passive * stiffness) ** 0.5
        if is_passive(plant, middle, coupling):
            passive = middle
        else:
            stiffness = middle
    return passive
