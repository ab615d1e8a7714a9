"""Faults in virtual time: what came of each injection, and which rules of safety it broke."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from random import Random

from .causes import Cause, Outcome
from .rows import Row
from .servo_host import DEEP, cube
from .virtual_press import MAX_FORCE, MAX_SLEW, PERIOD, RAMP_SECONDS, Shot, VirtualPress

ROUNDING = 1e-9
DEVICE_ROUNDING = 1e-3
"""FORCE is in mN, each axis rounded."""
WATCHDOG_SECONDS = 0.020
WATCHDOG_TICKS = 20


@dataclass(frozen=True)
class Episode:
    """One injection: the tick before, those of the cause, and those until all is as it was."""

    before: Shot
    during: list[Shot]
    back: list[Shot]
    counted: int
    """By how much the cause's counter rose."""
    faults: int
    """How many faults were counted."""

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


def counted(press: VirtualPress, name: str) -> int:
    """A counter of the link; `damaged` is the sum of all that damage may be taken for."""
    link = press.servo.counters()["link"]
    counts = {str(key): value for key, value in link.items() if isinstance(value, int)}
    if name == "damaged":
        return sum(counts[key] for key in ("crc_errors", "cobs_errors", "oversize", "unknown"))
    return counts.get(name, 0)


def episode(press: VirtualPress, cause: Cause, dice: Random) -> Episode:
    """Bring the cause about in the middle of a press, and go on until the body is felt again."""
    press.glide(DEEP)
    before = press.press()[-1]
    counts, faults = counted(press, cause.counter), sum(press.servo.counters()["faults"].values())
    during = cause.inject(press, dice)
    back = press.press()
    return Episode(
        before,
        during,
        back,
        counted(press, cause.counter) - counts,
        sum(press.servo.counters()["faults"].values()) - faults,
    )


def problems(cause: Cause, one: Episode) -> list[str]:
    """The rules that this episode breaks."""
    match cause.outcome:
        case Outcome.SILENT:
            return _silence_problems(cause, one)
        case Outcome.HARMLESS:
            found = [] if one.counted else [f"{cause.counter} not counted"]
            if one.faults:
                found.append("a fault without need")
            if any(abs(shot.output - one.before.output) > ROUNDING for shot in one.all):
                found.append("the force changed")
            return found
        case Outcome.LIMITED:
            return _limit_problems(cause, one)


def _silence_problems(cause: Cause, one: Episode) -> list[str]:
    found = []
    if one.ticks_to_zero > cause.zero_within:
        found.append(f"force for {one.ticks_to_zero} ticks after the cause")
    if any(shot.output > 0.0 for shot in one.silent):
        found.append("force while there must be none")
    # One tick later the device has it, or its watchdog finds that there is nothing.
    heard = one.ticks_to_zero + (WATCHDOG_TICKS if cause.line_gone else 1)
    felt = one.all[heard : one.ticks_to_zero + len(one.silent)]
    if any(shot.felt > 0.0 for shot in felt):
        found.append("the motors go on")
    if cause.named not in {shot.name for shot in one.all}:
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
    if max(shot.felt for shot in one.all) > MAX_FORCE + DEVICE_ROUNDING:
        found.append("the device made more than its largest force")
    grown = [
        shot.change
        for last, shot in zip([one.before, *one.all], one.all, strict=False)
        if shot.output > last.output
    ]
    if max(grown, default=0.0) > MAX_SLEW * PERIOD + ROUNDING:
        found.append("beyond the slew limit")
    if cause.named not in {shot.limited for shot in one.all}:
        found.append(f"never limited by {cause.named!r}")
    return found


def virtual_row(cause: Cause, times: int, dice: Random) -> Row:
    """Inject one cause many times."""
    press = VirtualPress(cube())
    broken: Counter[str] = Counter()
    seen: Counter[str] = Counter()
    episodes = []
    for _ in range(times):
        one = episode(press, cause, dice)
        episodes.append(one)
        broken.update(problems(cause, one))
        named = [s.name for s in one.all if s.output == 0.0 and s.state != "free"]
        seen.update([cause.named if cause.named in named else (named or ["touching"])[0]])
    silent = cause.outcome is Outcome.SILENT
    to_zero = max(one.ticks_to_zero for one in episodes) if silent else None
    return Row(
        injected=cause.name,
        times=times,
        seen=cause.named if cause.outcome is Outcome.LIMITED else seen.most_common(1)[0][0],
        at_cause=max(one.during[0].output for one in episodes),
        after=max(
            max((s.output for s in (one.silent if silent else one.all)), default=0.0)
            for one in episodes
        ),
        ticks_to_zero=to_zero,
        back_ms=max(len(one.returning) for one in episodes) * PERIOD * 1e3 if silent else None,
        device=f"at most {max(s.felt for one in episodes for s in one.all):.2f} N",
        broken=tuple(f"{rule} ({count})" for rule, count in broken.items()),
    )


def killed_row(times: int, dice: Random) -> Row:
    """A host that says nothing any more: the device's own watchdog, in its own time."""
    press = VirtualPress(cube())
    slowest = 0.0
    broken: list[str] = []
    for _ in range(times):
        press.glide(DEEP)
        press.press()
        limp = press.device.counters.limp_count
        for _ in range(30 + dice.randrange(100)):
            press.tick(device_hears=False)
        if press.device.counters.limp_count != limp + 1:
            broken.append("not limp, or more than once")
        slowest = max(slowest, press.device.counters.limp_after)
        press.press()
    if slowest > WATCHDOG_SECONDS + ROUNDING:
        broken.append("the watchdog is late")
    return Row(
        injected="the host's last word was a force",
        times=times,
        seen="device fault",
        device=f"limp {slowest * 1e3:.1f} ms after it",
        broken=tuple(broken),
    )
