"""What the servo's timing must hold, as ratios to a bare thread and a bare line in the same run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import binom

LONG_US = 12_000.0
"""Ticks later than this are counted: nothing but the machine may make one."""
MOST = 1.2
"""How many times the bare thread's figures the servo's may be."""
ENOUGH_TICKS = 30_000
"""So many are needed to tell."""
SIGNIFICANT = 0.05


@dataclass(frozen=True)
class Claim:
    """A figure of the servo beside that of its opponent."""

    name: str
    servo: float
    bare: float
    is_chance: bool = False
    """More than claimed, but no proof of it."""
    is_enough: bool = True
    """Whether there were ticks enough to tell."""

    @property
    def ratio(self) -> float:
        """How many times as much; none of each is as much."""
        if self.servo == self.bare:
            return 1.0
        return self.servo / self.bare if self.bare else np.inf

    @property
    def is_broken(self) -> bool:
        """Whether there is more than claimed."""
        return self.is_enough and self.ratio > MOST and not self.is_chance

    def __str__(self) -> str:
        """The ratio, and what it means, where the ticks suffice to tell."""
        if not self.is_enough:
            return f"{self.ratio:.2f}"
        held = "ok" if self.ratio <= MOST else "chance"
        return f"{self.ratio:.2f} {'MORE' if self.is_broken else held}"


def timing_claims(servo: Mapping[str, Any], bare: Mapping[str, Any]) -> list[Claim]:
    """Long gaps, late ticks and the tail, by the counters of both threads."""
    enough = min(servo["ticks"], bare["ticks"]) >= ENOUGH_TICKS
    long = [beyond(counters, LONG_US) for counters in (servo, bare)]
    late = [int(counters["late_ticks"]) for counters in (servo, bare)]
    tail = [float(counters["lateness_us"]["p99_9"]) for counters in (servo, bare)]
    far = MOST * tail[1]
    few_far = is_chance(beyond(servo, far), beyond(bare, far / MOST), 1.0)
    return [
        Claim("> 12 ms", *long, is_chance(*long, 1.0), enough),
        Claim("late", *late, is_chance(*late, MOST), enough),
        Claim("p99.9 us", *tail, few_far, enough),
    ]


def answer_claim(
    waits: Mapping[str, float], bare: Mapping[str, Any], line_us: float, period_us: float
) -> Claim:
    """How long STATE waits for its FORCE at p99.9, us.

    Whoever answers in ticks waits for a period, a bare thread's lateness, and a bare line's time.
    """
    alone = period_us + float(bare["lateness_us"]["p99_9"]) + line_us
    enough = bare["ticks"] >= ENOUGH_TICKS
    return Claim("STATE to FORCE", waits["p99_9"], alone, is_enough=enough)


def is_chance(one: int, other: int, most: float) -> bool:
    """Whether counts that differ like that are no proof of more than `most` times as many.

    An exact binomial test of one against the sum of both, at 5 %. Late ticks come in bursts, so it
    is too strict rather than too lenient.
    """
    return float(binom.sf(one - 1, one + other, most / (1.0 + most))) > SIGNIFICANT


def beyond(counters: Mapping[str, Any], us: float) -> int:
    """Ticks later than this."""
    return int(sum(count for limit, count in counters["histogram"] if limit > us))
