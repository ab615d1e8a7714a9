"""Keyframes of the simulated hand's target and of the stylus' rotation, with minimum-jerk moves
between them.
"""

from __future__ import annotations

import bisect
import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from ...core.errors import PalpateError
from ...core.files.small_text import json_value, read_small_text
from .plant import Vector
from .quaternion import UPRIGHT, Quaternion, about, between, unit

# Of a script's file: a hundred thousand keyframes.
MOST_BYTES = 10_000_000


def minimum_jerk(s: float) -> float:
    """Minimum-jerk profile from 0 to 1: 10 s^3 - 15 s^4 + 6 s^5, at rest at both ends."""
    s = min(max(s, 0.0), 1.0)
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))


@dataclass(frozen=True)
class TurnScript:
    """Keyframes of rotation: times in s, rising; unit quaternions (w, x, y, z), stylus to device.
    From `repeat_from` on it repeats for ever. Raises PalpateError for invalid ones.
    """

    times: tuple[float, ...]
    rotations: tuple[Quaternion, ...]
    repeat_from: float | None = None

    def __post_init__(self) -> None:
        _check(self.times, self.rotations, self.repeat_from)
        if any(abs(math.hypot(*rotation) - 1.0) > 1e-6 for rotation in self.rotations):
            raise PalpateError("the hand's script has a quaternion that is not of length 1")

    def at(self, time: float) -> Quaternion:
        """Rotation at `time`, on the shorter way between two keyframes."""
        before, after, s = _around(time, self.times, self.repeat_from)
        return between(self.rotations[before], self.rotations[after], s)


@dataclass(frozen=True)
class HandScript:
    """Keyframes of position: times in s, rising; m. From `repeat_from` on it repeats for ever.

    turns : of the stylus; None for a hand that does not turn it.
    Raises PalpateError for invalid ones.
    """

    times: tuple[float, ...]
    positions: tuple[Vector, ...]
    repeat_from: float | None = None
    turns: TurnScript | None = None

    def __post_init__(self) -> None:
        _check(self.times, self.positions, self.repeat_from)

    def at(self, time: float) -> Vector:
        """Target at `time`; constant before the first keyframe and after the last."""
        before, after, s = _around(time, self.times, self.repeat_from)
        a, b = self.positions[before], self.positions[after]
        return (a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2]))


def _check(
    times: tuple[float, ...], places: Sequence[tuple[float, ...]], repeat_from: float | None
) -> None:
    if not times or len(times) != len(places):
        raise PalpateError("the hand's script needs a position for every time, at least one")
    if not all(map(math.isfinite, (*times, *(x for place in places for x in place)))):
        raise PalpateError("the hand's script has a value that is no number; remove it")
    if any(later <= earlier for earlier, later in pairwise(times)):
        raise PalpateError("the hand's script has times that do not rise; sort its lines")
    if repeat_from is not None and not repeat_from < times[-1]:
        raise PalpateError("the hand's script repeats from after its end; take an earlier time")


def _around(
    time: float, times: tuple[float, ...], repeat_from: float | None
) -> tuple[int, int, float]:
    """Keyframes before and after `time`, and the fraction of the interval elapsed; before the
    first and after the last it is that one twice.
    """
    last = times[-1]
    if repeat_from is not None and time > last:
        time = repeat_from + (time - repeat_from) % (last - repeat_from)
    after = bisect.bisect_right(times, time)
    if after == 0 or after == len(times):
        only = max(after - 1, 0)
        return only, only, 0.0
    begin, end = times[after - 1], times[after]
    return after - 1, after, minimum_jerk((time - begin) / (end - begin))


def tilt_script(axis: Vector, degrees: float, period: float) -> TurnScript:
    """Tilt the stylus about `axis` (device axes) by so much and back in `period` seconds, for ever.

    Raises PalpateError for a zero axis, half a turn or more, or an invalid period.
    """
    if not (abs(degrees) < 180.0 and 0.0 < period < math.inf):
        raise PalpateError("the hand's turning must be less than 180 degrees, its period over 0 s")
    try:
        tilted = about(axis, math.radians(degrees))
    except ValueError as error:
        raise PalpateError(f"the hand cannot turn the stylus: {error}") from error
    return TurnScript((0.0, 0.5 * period, period), (UPRIGHT, tilted, UPRIGHT), repeat_from=0.0)


def press_script(
    rest: Vector, at: Vector, by: Vector, *, approach: float, period: float, hold: float
) -> HandScript:
    """Script from `rest` to `at` in `approach` seconds, then repeated presses by `by`.

    A press takes `period` seconds, `hold` of them at the deepest point; an infinite `hold` presses
    once and stays.
    """
    if not (approach > 0.0 and period > 0.0 and hold >= 0.0):
        raise PalpateError(
            "the hand's approach and period must be more than 0 s, hold at least 0 s"
        )
    deep = (at[0] + by[0], at[1] + by[1], at[2] + by[2])
    half = 0.5 * period
    if math.isinf(hold):
        return HandScript((0.0, approach, approach + half), (rest, at, deep))
    if hold >= period:
        raise PalpateError(f"the hand cannot hold {hold:g} s of a press of {period:g} s")
    way = 0.5 * (period - hold)
    times = [0.0, approach, approach + way, approach + way + hold, approach + period]
    positions = [rest, at, deep, deep, at]
    if hold == 0.0:
        del times[3], positions[3]
    return HandScript(tuple(times), tuple(positions), repeat_from=approach)


def read_script(path: Path) -> HandScript:
    """Script from a file: CSV lines `t,x,y,z` (s, m), or JSON. With `t,x,y,z,qw,qx,qy,qz` in
    every line the hand turns the stylus too; quaternions are normalized.

    JSON: {"keyframes": [[t, x, y, z], ...], "repeat_from": seconds or null}.
    Raises PalpateError for an unreadable or invalid file.
    """
    try:
        return _script(read_small_text(path, MOST_BYTES))
    except (ValueError, LookupError, TypeError, OverflowError, csv.Error) as error:
        raise PalpateError(
            f"{path}: not a script of the hand ({error}); write CSV lines t,x,y,z "
            "or t,x,y,z,qw,qx,qy,qz, or JSON "
            '{"keyframes": [[t, x, y, z], ...]}'
        ) from error
    except PalpateError as error:
        if str(path) in str(error):
            raise
        raise PalpateError(f"{path}: {error}; correct its keyframes") from error


def _script(text: str) -> HandScript:
    if text.lstrip().startswith("{"):
        content = json_value(text)
        rows, repeat_from = content["keyframes"], content.get("repeat_from")
    else:
        rows = [row for row in csv.reader(io.StringIO(text)) if row and row[0].strip() != "t"]
        repeat_from = None
    repeat = None if repeat_from is None else float(repeat_from)
    times = tuple(float(row[0]) for row in rows)
    places = tuple((float(x), float(y), float(z)) for _, x, y, z, *_ in rows)
    turns = _turns([[float(part) for part in row[4:]] for row in rows])
    turning = TurnScript(times, turns, repeat) if turns else None
    return HandScript(times, places, repeat, turning)


def _turns(quaternions: list[list[float]]) -> tuple[Quaternion, ...]:
    """Unit quaternions of all lines, or none if no line has any; raises ValueError."""
    if not any(quaternions):
        return ()
    return tuple(unit((w, x, y, z)) for w, x, y, z in quaternions)
