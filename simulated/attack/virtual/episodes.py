"""Attacks in virtual time: what came of each injection, and which rules of safety it broke."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random

from ..table import Row, counted
from .cause import Cause, Outcome
from .shot import Shot
from .virtual_press import MAX_FORCE, MAX_SLEW, PERIOD, RAMP_SECONDS, NotFeltError, VirtualPress

ROUNDING = 1e-9
DEVICE_ROUNDING = 1e-3
"""FORCE is in mN, each axis rounded."""
SLEW_ROUNDING = 3.0
"""The same from one tick to the next, N/s."""
WATCHDOG_SECONDS = 0.020
WATCHDOG_TICKS = 20

Make = Callable[[int], VirtualPress]
"""A press with a device of so many STATE a second."""


@dataclass(frozen=True)
class Episode:
    """One injection: the tick before, those of the cause, and those until all is as it was."""

    before: Shot
    during: list[Shot]
    back: list[Shot]
    counted: int
    """By how much the cause's counter rose."""
    faults: int
    """How many faults were counted in its course."""

    @property
    def all(self) -> list[Shot]:
        """From the cause on."""
        return self.during + self.back

    @property
    def ticks_to_zero(self) -> int:
        """From the cause's tick to the first without force."""
        return next((i for i, shot in enumerate(self.all) if shot.output == 0.0), len(self.all))

    @property
    def silent(self) -> list[Shot]:
        """From zero force until force is allowed again."""
        rest = self.all[self.ticks_to_zero :]
        end = next((i for i, s in enumerate(rest) if s.state in ("ramping", "free")), len(rest))
        return rest[: max(1, end)]

    @property
    def returning(self) -> list[Shot]:
        """The ticks of the ramp and after it."""
        return self.all[self.ticks_to_zero + len(self.silent) :]

    def forbidden(self, cause: Cause) -> list[Shot]:
        """The ticks in which there must be no force."""
        match cause.outcome:
            case Outcome.SILENT:
                return self.silent
            case Outcome.UNFELT:
                return self.during
            case _:
                return []


def fits_above(cause: Cause) -> bool:
    """Whether it is brought about close above the body, and not in a press."""
    return cause.outcome in (Outcome.UNFELT, Outcome.UNNOTICED)


def episode(press: VirtualPress, cause: Cause, dice: Random) -> Episode:
    """Bring the cause about in a press or close above the body; then go on until it is felt."""
    if fits_above(cause):
        before = press.hover()[-1]
    else:
        press.glide(press.target.deep)
        before = press.press()[-1]
    counts, faults = press.count(cause.counter), press.faults
    during = cause.inject(press, dice)
    faults = press.faults - faults
    back = [] if fits_above(cause) else press.press()
    return Episode(before, during, back, press.count(cause.counter) - counts, faults)


def problems(cause: Cause, one: Episode) -> list[str]:
    """The rules that this episode breaks."""
    found = _motor_problems(one)
    match cause.outcome:
        case Outcome.SILENT:
            found += _silence_problems(cause, one)
        case Outcome.HARMLESS:
            found += [] if one.counted else [f"{cause.counter} not counted"]
            if one.faults:
                found.append("a fault without need")
            if any(abs(shot.output - one.before.output) > ROUNDING for shot in one.all):
                found.append("the force changed")
        case Outcome.LIMITED:
            found += _limit_problems(cause, one)
        case Outcome.UNFELT:
            if any(shot.output > 0.0 or shot.said.driving for shot in one.during):
                found.append("felt")
        case Outcome.UNNOTICED:
            if one.faults:
                found.append("a fault without need")
    return found


def _motor_problems(one: Episode) -> list[str]:
    found = []
    if any(shot.said.hollow for shot in one.all):
        found.append("a force with the motors off")
    if max(shot.felt for shot in one.all) > MAX_FORCE + DEVICE_ROUNDING:
        found.append("the device made more than its largest force")
    if max(shot.felt_slew for shot in one.all) > MAX_SLEW + SLEW_ROUNDING:
        found.append("beyond the slew limit")
    return found


def _silence_problems(cause: Cause, one: Episode) -> list[str]:
    found = []
    if one.ticks_to_zero > cause.zero_within:
        found.append("force after the cause")
    if any(shot.output > 0.0 for shot in one.silent) or any(
        shot.said.driving for shot in one.silent[cause.felt_within - 1 :]
    ):
        found.append("force while there must be none")
    first = one.silent[: cause.felt_within]
    if not cause.line_gone and not any(shot.said.released for shot in first):
        found.append("zero is not said")
    # One tick later the device has it, or its watchdog finds that there is nothing.
    heard = one.ticks_to_zero + (WATCHDOG_TICKS if cause.line_gone else cause.felt_within)
    felt = one.all[heard : one.ticks_to_zero + len(one.silent)]
    if any(shot.felt > 0.0 for shot in felt):
        found.append("the motors go on")
    if cause.named and cause.named not in {shot.name for shot in one.all}:
        found.append(f"never called {cause.named!r}")
    for tick, shot in enumerate(one.returning, start=1):
        gain = min(1.0, (tick + 1) * PERIOD / RAMP_SECONDS)
        if shot.output > gain * min(shot.wanted, MAX_FORCE) + ROUNDING:
            found.append("no ramp")
            break
    return found


def _limit_problems(cause: Cause, one: Episode) -> list[str]:
    found = []
    if max(shot.output for shot in one.all) > MAX_FORCE + ROUNDING:
        found.append("beyond the clamp")
    grown = [
        shot.change
        for last, shot in zip([one.before, *one.all], one.all, strict=False)
        if shot.output > last.output
    ]
    if max(grown, default=0.0) > MAX_SLEW * PERIOD + ROUNDING:
        found.append("beyond the slew limit")
    if cause.named and cause.named not in {shot.limited for shot in one.all}:
        found.append(f"never limited by {cause.named!r}")
    return found


@dataclass
class _Sum:
    """What all episodes of a row came to."""

    broken: Counter[str] = field(default_factory=Counter)
    told: Counter[str] = field(default_factory=Counter)
    force: float = 0.0
    frames: int = 0
    felt: float = 0.0
    slew: float = 0.0
    zero: int = 0
    back: int = 0

    def add(self, cause: Cause, one: Episode) -> None:
        self.broken.update(problems(cause, one))
        for shot in one.forbidden(cause):
            self.force = max(self.force, shot.output)
            self.frames += shot.said.driving
        self.felt = max(self.felt, *(shot.felt for shot in one.all))
        self.slew = max(self.slew, *(shot.felt_slew for shot in one.all))
        self.zero = max(self.zero, one.ticks_to_zero)
        self.back = max(self.back, len(one.returning))
        named = [s.name for s in one.all if s.output == 0.0 and s.state != "free"]
        limited = cause.outcome is Outcome.LIMITED
        is_named = cause.named in named or limited
        self.told.update([cause.named if is_named else (named or [one.during[-1].state])[0]])


def attacked(make: Make, cause: Cause, times: int, seed: int) -> Row:
    """Inject one cause many times; what is random depends on seed, cause and number alone."""
    sums = _Sum()
    lasting: dict[int, VirtualPress] = {}
    for number in range(times):
        dice = Random(f"{seed} {cause.name} {number}")  # noqa: S311 - which fault, not secrets
        rate = dice.choice(cause.rates)
        if fits_above(cause) or rate not in lasting:
            lasting[rate] = make(rate)
        try:
            sums.add(cause, episode(lasting[rate], cause, dice))
        except NotFeltError:
            sums.broken["no force ever again"] += 1
            del lasting[rate]
    silent = cause.outcome is Outcome.SILENT
    none_allowed = silent or cause.outcome is Outcome.UNFELT
    return Row(
        injected=cause.name,
        times=times,
        told=next((name for name, _ in sums.told.most_common(1)), ""),
        broken=counted(sums.broken),
        force=sums.force if none_allowed else None,
        frames=sums.frames if none_allowed else None,
        felt=sums.felt,
        slew=sums.slew,
        zero_ms=sums.zero * PERIOD * 1e3 if silent else None,
        back_ms=sums.back * PERIOD * 1e3 if silent else None,
    )


def unheard(make: Make, times: int, seed: int) -> Row:
    """A host that says nothing any more: the device's own watchdog, in its own time."""
    press, dice = make(1000), Random(f"{seed} unheard")  # noqa: S311 - as above
    slowest = 0.0
    broken: Counter[str] = Counter()
    for _ in range(times):
        press.glide(press.target.deep)
        press.press()
        limp = press.device.counters.limp_count
        for _ in range(30 + dice.randrange(100)):
            press.tick(device_hears=False)
        if press.device.counters.limp_count != limp + 1:
            broken["not limp, or more than once"] += 1
        slowest = max(slowest, press.device.counters.limp_after)
        press.press()
    if slowest > WATCHDOG_SECONDS + ROUNDING:
        broken["the watchdog is late"] += 1
    return Row(
        injected="the host's last word was a force",
        times=times,
        told="device fault",
        zero_ms=slowest * 1e3,
        broken=counted(broken),
    )
